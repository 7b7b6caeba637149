//! Unbalance of a rigid rotor: its static and its couple part, and whether one plane is enough.

use super::error::Error;
use super::scalar::{Complex, Scalar, given, real, zero};

/// Width over diameter up to which a rotor is balanced statically, in one plane [Notes ch. 5].
const DISC: f64 = 0.2;

/// Unbalance of a rigid rotor about its centre of mass.
///
/// Static balance is `sum m r = 0`, dynamic balance that of forces and moments, which takes two planes [Notes ch. 5].
/// Any dynamic unbalance is a static part, which acts in the centre of mass, and a couple part, two opposite
/// unbalances in two planes. Derived.
///
/// ```
/// use driveline::balancing::{Complex, RigidUnbalance};
/// // 2 g m on either side, 0.3 m from the centre of mass, in opposition: in static balance, a couple of 1.2 g m2
/// let two = Complex::new(2e-3_f64, 0.0);
/// let unbalance = RigidUnbalance::of([(two, 0.3), (-two, -0.3)])?;
/// assert!(unbalance.resultant.norm() < 1e-15 && (unbalance.couple.norm() - 1.2e-3).abs() < 1e-15);
/// # Ok::<(), driveline::balancing::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
// Not logged: the complex numbers of `nalgebra` have no `Format`.
#[doc(alias = "imbalance")]
pub struct RigidUnbalance<T: Scalar> {
    /// Static unbalance (kg m): the sum of all.
    pub resultant: Complex<T>,
    /// Couple unbalance (kg m2): the sum of each times its distance from the centre of mass.
    pub couple: Complex<T>,
}

impl<T: Scalar> RigidUnbalance<T> {
    /// Resultant and couple of unbalances along a rotor (kg m), each at its distance from the centre of mass (m).
    ///
    /// # Errors
    /// [`Error::Weight`] with the index of an unbalance, [`Error::Setting`] with that of a distance, that is not a
    /// number.
    pub fn of(unbalances: impl IntoIterator<Item = (Complex<T>, T)>) -> Result<Self, Error> {
        let mut sum = RigidUnbalance { resultant: zero(), couple: zero() };
        for (index, (unbalance, at)) in unbalances.into_iter().enumerate() {
            if !given(unbalance) {
                return Err(Error::Weight { plane: index });
            }
            if !at.is_finite() {
                return Err(Error::Setting { index });
            }
            sum.resultant += unbalance;
            sum.couple += unbalance.scale(at);
        }
        Ok(sum)
    }
}

/// Whether a rotor of this width and diameter (m) is balanced statically, in one plane: width over diameter is at most
/// 1/5 [Notes ch. 5].
///
/// # Errors
/// [`Error::Setting`] with the index of the value that is not positive.
pub fn one_plane_suffices<T: Scalar>(width: T, diameter: T) -> Result<bool, Error> {
    match [width, diameter].iter().position(|value| !(*value > T::zero() && value.is_finite())) {
        Some(index) => Err(Error::Setting { index }),
        None => Ok(width <= diameter * real(DISC)),
    }
}
