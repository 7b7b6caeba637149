//! Permissible residual unbalance and its split between planes (ISO 21940-11), and unbalances resolved into two planes.

use super::error::Error;
use super::scalar::{Complex, Scalar, real, size, zero};

/// The balance quality grades (mm/s).
pub const GRADES: [f64; 11] = [0.4, 1.0, 2.5, 6.3, 16.0, 40.0, 100.0, 250.0, 630.0, 1600.0, 4000.0];

/// A rotor whose residual unbalance is judged.
///
/// ```
/// use driveline::balancing::BalanceTolerance;
/// // a grinding wheel of 140 kg at 77 rad/s in G2.5: 2.5e-3 140/77 kg m
/// const WHEEL: BalanceTolerance<f64> = BalanceTolerance { grade: 2.5, mass: 140.0, speed: 77.0 };
/// assert!((WHEEL.permissible()? - 4.545e-3).abs() < 1e-6);
/// assert_eq!(WHEEL.judge(1.0e-3)?.fulfils, Some(1.0)); // 0.55 mm/s
/// # Ok::<(), driveline::balancing::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[doc(alias("ISO 21940", "ISO 1940", "unbalance"))]
pub struct BalanceTolerance<T> {
    /// Balance quality grade G, the speed of the centre of mass about the axis (mm/s).
    pub grade: T,
    /// Mass (kg).
    pub mass: T,
    /// Highest service speed (rad/s).
    pub speed: T,
}

/// Grade of a residual unbalance.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Verdict<T> {
    /// The grade that it has (mm/s).
    pub grade: T,
    /// The next standard grade that it fulfils (mm/s); none where it is worse than all.
    pub fulfils: Option<T>,
    /// Whether it is within the tolerance.
    pub passed: bool,
}

impl<T: Scalar> BalanceTolerance<T> {
    /// # Errors
    /// [`Error::Setting`] with the index of the value that is not positive.
    fn check(&self) -> Result<(), Error> {
        let right = |value: &T| *value > T::zero() && value.is_finite();
        match [self.grade, self.mass, self.speed].iter().position(|value| !right(value)) {
            Some(index) => Err(Error::Setting { index }),
            None => Ok(()),
        }
    }

    /// Permissible residual unbalance of the rotor (kg m): `U = G m / omega` [ISO 21940-11].
    ///
    /// # Errors
    /// [`Error::Setting`] with the index of the value that is not positive.
    pub fn permissible(&self) -> Result<T, Error> {
        self.check()?;
        Ok(self.grade * real(1e-3) * self.mass / self.speed)
    }

    /// The same for two tolerance planes at the bearings A and B (kg m), by the distances of the centre of mass from
    /// them (m).
    ///
    /// `from_a` is counted towards B, so that a centre of mass between the bearings has 0 < `from_a` < `span`. The
    /// shares are held within 0.3 and 0.7 between bearings, 0.3 and 1.3 overhung.
    ///
    /// # Errors
    /// [`Error::Setting`] with the index of the value that is not positive, the span being the fourth.
    pub fn at_bearings(&self, from_a: T, span: T) -> Result<[T; 2], Error> {
        let whole = self.permissible()?;
        if !(span > T::zero() && span.is_finite() && from_a.is_finite()) {
            return Err(Error::Setting { index: 3 });
        }
        let between = from_a >= T::zero() && from_a <= span;
        let (least, most) = (real(0.3), real(if between { 0.7 } else { 1.3 }));
        let held = |share: T| share.abs().max(least).min(most);
        Ok([whole * held((span - from_a) / span), whole * held(from_a / span)])
    }

    /// Judges a residual unbalance of the rotor (kg m).
    ///
    /// # Errors
    /// [`Error::Setting`] with the index of the value that is not positive.
    pub fn judge(&self, residual: T) -> Result<Verdict<T>, Error> {
        let permissible = self.permissible()?;
        let grade = residual * self.speed / self.mass * real(1e3);
        // by the permissible residual itself, so that one of exactly that is within its grade
        let within =
            |known: &T| BalanceTolerance { grade: *known, ..*self }.permissible().is_ok_and(|most| residual <= most);
        let fulfils = GRADES.iter().map(|&known| real::<T>(known)).find(within);
        Ok(Verdict { grade, fulfils, passed: residual <= permissible })
    }
}

/// Unbalances along a rotor (kg m at m) as two in the planes at `a` and `b` (m): each splits by its distances
/// [Notes ch. 5]. The correction is the opposite.
///
/// This separates the planes of a balancing machine with hard bearings: the unbalances in its bearings, each force
/// over the square of the speed, as those in the correction planes. With soft bearings vibration is measured, and the
/// planes are separated by the two trial runs of an [`Influence`](super::Influence).
///
/// # Errors
/// [`Error::Setting`] where the planes are the same.
pub fn two_planes<T: Scalar>(
    unbalances: impl IntoIterator<Item = (Complex<T>, T)>,
    a: T,
    b: T,
) -> Result<[Complex<T>; 2], Error> {
    let span = b - a;
    if !(span.abs() > T::zero() && span.is_finite()) {
        return Err(Error::Setting { index: 0 });
    }
    let mut sums = [zero(); 2];
    for (unbalance, at) in unbalances {
        let [in_a, in_b] = sums;
        sums = [in_a + unbalance.scale((b - at) / span), in_b + unbalance.scale((at - a) / span)];
    }
    Ok(sums)
}

/// The unbalance of the whole rotor (kg m): the size of the sum of its planes'.
pub fn resultant<T: Scalar>(unbalances: &[Complex<T>]) -> T {
    size(unbalances.iter().fold(zero(), |sum, unbalance| sum + *unbalance))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three and four at right angles are five, whose square and root are exact.
    #[test]
    fn unbalances_add_as_vectors() {
        let z = |re: f64, im: f64| Complex { re, im };
        assert_eq!(resultant(&[z(3.0, -2.0), z(0.0, 6.0)]), 5.0);
        assert_eq!(resultant::<f64>(&[]), 0.0);
    }

    /// A rotor of 1 kg at 1 rad/s has its grade's thousandth (kg m): 2.5 mm/s is 0.0025, and a millionth more is of the
    /// next grade, 6.3; a worse one than 4000 mm/s has none.
    #[test]
    fn a_residual_has_the_grade_that_it_is_within() {
        let rotor = BalanceTolerance { grade: 40.0, mass: 1.0, speed: 1.0 };
        let fulfils = |residual: f64| rotor.judge(residual).unwrap().fulfils;
        assert_eq!(fulfils(BalanceTolerance { grade: 2.5, ..rotor }.permissible().unwrap()), Some(2.5));
        assert_eq!((fulfils(0.0025 * (1.0 + 1e-6)), fulfils(0.0025 * (1.0 - 1e-6))), (Some(6.3), Some(2.5)));
        // two products and a division
        assert!((rotor.judge(0.0025).unwrap().grade - 2.5).abs() < 1e-15);
        // 0.5 mm of eccentricity at 50 rad/s: 25 mm/s
        let heavy = BalanceTolerance { mass: 2.0, speed: 50.0, ..rotor };
        assert!((heavy.judge(0.001).unwrap().grade / 25.0 - 1.0).abs() < 1e-15);
        assert_eq!((fulfils(0.0), fulfils(3.999), fulfils(4.001)), (Some(0.4), Some(4000.0), None));
    }
}
