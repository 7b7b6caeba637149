//! Splitting a correction weight between real holes and stock weights.

use super::error::Error;
use super::matrix::pick;
use super::scalar::{Complex, Scalar, real, size, zero};

/// Whether weight is screwed on or drilled out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum CorrectionMethod {
    /// Weight is added at the correction's angle.
    #[default]
    Adding,
    /// Weight is taken off on the other side.
    Removing,
}

/// The holes of a plane and the weights for them.
///
/// ```
/// use driveline::balancing::{Complex, CorrectionMethod, Holes};
/// // twelve holes, screws of 1, 2 and 5 g; wanted: 10 g between the first two holes
/// let angles: Vec<f64> = (0..12).map(|hole| f64::from(hole) * 30.0_f64.to_radians()).collect();
/// let holes = Holes { angles: &angles, weights: &[1.0, 2.0, 5.0], method: CorrectionMethod::Adding };
/// let fitted = holes.fit(Complex::from_polar(10.0, 15.0_f64.to_radians()))?;
/// assert_eq!(fitted.holes, [(0, 5.0), (1, 5.0)]);
/// assert!((fitted.sum.norm() - 10.0 * 15.0_f64.to_radians().cos()).abs() < 1e-12);
/// # Ok::<(), driveline::balancing::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
// Not logged: the complex numbers of `nalgebra` have no `Format`.
pub struct Holes<'a, T> {
    /// Angles of the holes (rad).
    pub angles: &'a [T],
    /// Stock weights, each available any number of times, in the unit of the weights; a hole may also stay empty.
    pub weights: &'a [T],
    /// Whether weight is added or removed.
    pub method: CorrectionMethod,
}

/// The chosen holes and weights.
#[derive(Clone, Copy, Debug, PartialEq)]
// Not logged: the complex numbers of `nalgebra` have no `Format`.
pub struct Fitted<T: Scalar> {
    /// Two holes, by their places in [`Holes::angles`], and the weight in each; a weight of zero is none.
    pub holes: [(usize, T); 2],
    /// The weight that they make together, as if it were added.
    pub sum: Complex<T>,
}

impl<T: Scalar> Holes<'_, T> {
    /// The hole or two holes and their weights that come nearest to a weight; of those that come equally near, the
    /// lightest.
    ///
    /// Every pair of holes is tried with every weight in one of them and the best for the other: nothing of one or two
    /// weights comes nearer, and a further hole or weight never makes the result worse. Takes holes squared times
    /// weights squared steps.
    ///
    /// # Errors
    /// [`Error::NothingToFit`]; [`Error::Setting`] with the place of a weight that is not positive or an angle that is
    /// no number; [`Error::TooHeavy`] (of plane 0) where even the heaviest weights in the best holes leave more than
    /// half.
    pub fn fit(&self, wanted: Complex<T>) -> Result<Fitted<T>, Error> {
        if self.angles.is_empty() || self.weights.is_empty() {
            return Err(Error::NothingToFit);
        }
        if let Some(index) = self.weights.iter().position(|weight| !(*weight > T::zero() && weight.is_finite())) {
            return Err(Error::Setting { index });
        }
        if let Some(index) = self.angles.iter().position(|angle| !angle.is_finite()) {
            return Err(Error::Setting { index });
        }
        let target = match self.method {
            CorrectionMethod::Adding => wanted,
            CorrectionMethod::Removing => -wanted,
        };
        let mut least = size(target);
        self.each(target, |_, _, left| least = least.min(left));
        // rounding, between weights of equal effect
        let near = least + (size(target) + self.heaviest()) * T::default_epsilon() * real(8.0);
        let mut best = Fitted { holes: [(0, T::zero()); 2], sum: zero() };
        let mut lightest = if size(target) <= near { Some(T::zero()) } else { None };
        self.each(target, |holes, sum, left| {
            let weight = holes.iter().fold(T::zero(), |all, (_, weight)| all + *weight);
            if left <= near && lightest.is_none_or(|lightest| weight < lightest) {
                (lightest, best) = (Some(weight), Fitted { holes, sum });
            }
        });
        if least > size(target) * real(0.5) && size(target) > self.heaviest() {
            return Err(Error::TooHeavy { plane: 0 });
        }
        if self.method == CorrectionMethod::Removing {
            best.sum = -best.sum;
        }
        Ok(best)
    }

    /// Passes each candidate: holes and weights, their sum, and the residual.
    fn each(&self, target: Complex<T>, mut with: impl FnMut([(usize, T); 2], Complex<T>, T)) {
        for (first, _) in self.angles.iter().enumerate() {
            let along = self.way(first);
            for weight in self.near((target * along.conj()).re) {
                let sum = along.scale(weight);
                with([(first, weight), (first, T::zero())], sum, size(target - sum));
            }
            for second in first + 1..self.angles.len() {
                let other = self.way(second);
                // the same hole, which takes one weight
                if size(along - other) < real(1e-6) {
                    continue;
                }
                for &weight in self.weights {
                    let alone = along.scale(weight);
                    // the best weight of the second hole is next to the projection of the first one's residual
                    for more in self.near(((target - alone) * other.conj()).re) {
                        let sum = alone + other.scale(more);
                        with([(first, weight), (second, more)], sum, size(target - sum));
                    }
                }
            }
        }
    }

    /// Cosine and sine of a hole's angle.
    fn way(&self, hole: usize) -> Complex<T> {
        let (sine, cosine) = pick(self.angles, hole, T::zero()).sin_cos();
        Complex { re: cosine, im: sine }
    }

    fn heaviest(&self) -> T {
        self.weights.iter().fold(T::zero(), |most, weight| most.max(*weight))
    }

    /// No weight, the next below and the next above.
    fn near(&self, wanted: T) -> [T; 3] {
        let below =
            self.weights.iter().filter(|weight| **weight <= wanted).fold(T::zero(), |most, weight| most.max(*weight));
        let heaviest = self.heaviest();
        let above =
            self.weights.iter().filter(|weight| **weight >= wanted).fold(heaviest, |least, weight| least.min(*weight));
        [T::zero(), below, above]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fit(angles: &[f64], weights: &[f64], wanted: f64) -> Result<Fitted<f64>, Error> {
        Holes { angles, weights, method: CorrectionMethod::Adding }.fit(Complex { re: wanted, im: 0.0 })
    }

    #[test]
    fn a_stock_weight_of_nothing_is_refused() {
        assert_eq!(fit(&[0.0], &[1.0, 0.0], 1.0), Err(Error::Setting { index: 1 }));
    }

    #[test]
    fn no_hole_and_no_weight_fit_nothing() {
        assert_eq!([fit(&[], &[1.0], 1.0), fit(&[0.0], &[], 1.0)], [const { Err(Error::NothingToFit) }; 2]);
    }

    /// Weights at right angles, added or removed from the other side.
    #[test]
    fn two_holes_share_a_weight() {
        let (angles, weights) = ([0.0, core::f64::consts::FRAC_PI_2], [1.0, 2.0]);
        let wanted = Complex { re: 1.0, im: 2.0 };
        for (method, wanted) in [(CorrectionMethod::Adding, wanted), (CorrectionMethod::Removing, -wanted)] {
            let fitted = Holes { angles: &angles, weights: &weights, method }.fit(wanted).unwrap();
            assert_eq!(fitted.holes, [(0, 1.0), (1, 2.0)]);
            // the cosine of a quarter of a turn is a rounding from zero
            assert!((fitted.sum - wanted).norm_sqr() < 1e-30, "{fitted:?}");
        }
        let aside = Holes { angles: &angles[1..], weights: &weights, method: CorrectionMethod::Adding };
        assert_eq!(aside.fit(Complex { re: 0.0, im: 2.0 }).unwrap().holes[0], (0, 2.0));
    }

    /// Two weights at 60 degrees on either side do as one between them, which is the lighter.
    #[test]
    fn the_lightest_of_equal_effect_is_taken() {
        use core::f64::consts::FRAC_PI_3;
        assert_eq!(fit(&[FRAC_PI_3, -FRAC_PI_3, 0.0], &[1.0], 1.0).unwrap().holes, [(2, 1.0), (2, 0.0)]);
    }

    /// One weight of one leaves half of two, which is not more than half, and more than half of three. Where all holes
    /// are on other sides a weight of one is not too heavy for a weight of one: the best is none.
    #[test]
    fn too_heavy_is_more_than_half() {
        assert_eq!(fit(&[0.0], &[1.0], 2.0).unwrap().holes[0], (0, 1.0));
        assert_eq!(fit(&[0.0], &[1.0], 3.0), Err(Error::TooHeavy { plane: 0 }));
        let aside = fit(&[core::f64::consts::FRAC_PI_2], &[1.0], 1.0).unwrap();
        assert_eq!(aside, Fitted { holes: [(0, 0.0); 2], sum: zero() });
    }

    /// Two angles of the same hole take one weight.
    #[test]
    fn a_hole_given_twice_is_one_hole() {
        for again in [0.0, core::f64::consts::TAU] {
            let fitted = fit(&[0.0, again], &[1.0], 2.0).unwrap();
            // the sine of a turn is a rounding from zero
            assert!((fitted.sum.re - 1.0).abs() < 1e-15 && fitted.sum.im.abs() < 1e-15, "{fitted:?}");
        }
    }

    /// Of weights that miss by one and by two units in the last place, the lighter; of those that miss by thirty and by
    /// fifty, where sixteen count as rounding, the nearer. Whatever the unit of the weights is.
    #[test]
    fn rounding_does_not_choose_the_heavier() {
        for unit in [1.0, 1.0 / 1_048_576.0, 1_048_576.0] {
            let units = |count: f64| unit * (1.0 + count * f64::EPSILON);
            for (heavier, wanted, expected) in [(3.0, 2.0, 0.0), (80.0, 50.0, 80.0)] {
                let fitted = fit(&[0.0], &[unit, units(heavier)], units(wanted)).unwrap();
                assert_eq!(fitted.holes[0], (0, units(expected)), "{unit}");
            }
        }
    }
}
