//! The balancing head: a device that sets a correction while the rotor turns.

use super::scalar::Complex;

/// Where a head stands.
#[derive(Clone, Copy, Debug, PartialEq)]
// Not logged: the complex numbers of `nalgebra` have no `Format`.
pub enum HeadPosition<const PLANES: usize = 1> {
    /// At these weights (kg m), as measured; one that cannot be is taken for `Moving`.
    At([Complex<f32>; PLANES]),
    /// It moves, or its position is not valid yet.
    Moving,
    /// It has no sensor: a move takes [`BalancingDesign::travel`](super::BalancingDesign::travel) at most.
    Unmeasured,
}

/// A balancing head, or an electromagnetic actuator, in `PLANES` planes.
///
/// A weight is a mass times its radius at an angle from the rotor's zero, positive as the rotor's angle (kg m).
///
/// ```
/// use driveline::balancing::{BalancingHead, Complex, HeadPosition};
/// /// Two masses of 50 g on a radius of 0.1 m, each at an angle (rad): together up to 0.01 kg m.
/// struct TwoMasses([f32; 2]);
/// impl BalancingHead for TwoMasses {
///     type Error = core::convert::Infallible;
///     fn set(&mut self, [weight]: &[Complex<f32>; 1]) -> Result<(), Self::Error> {
///         let spread = (weight.norm() / 0.01).min(1.0).acos();
///         self.0 = [weight.arg() + spread, weight.arg() - spread];
///         Ok(())
///     }
///     fn position(&mut self) -> Result<HeadPosition, Self::Error> {
///         Ok(HeadPosition::At([self.0.map(|angle| Complex::from_polar(0.005, angle)).iter().sum()]))
///     }
/// }
/// let (mut head, weight) = (TwoMasses([0.0, core::f32::consts::PI]), Complex::new(0.0, 0.006));
/// head.set(&[weight])?;
/// assert!(matches!(head.position()?, HeadPosition::At([at]) if (at - weight).norm() < 1e-6));
/// # Ok::<(), core::convert::Infallible>(())
/// ```
pub trait BalancingHead<const PLANES: usize = 1> {
    /// Failure of its line or of its drive.
    type Error;

    /// Begins a move to these weights, from wherever it stands, and returns at once. A head that has lost its position
    /// finds it first.
    ///
    /// # Errors
    /// The head did not take the command; it is given again.
    fn set(&mut self, weights: &[Complex<f32>; PLANES]) -> Result<(), Self::Error>;

    /// Where it stands now.
    ///
    /// # Errors
    /// There is no answer; it is requested again.
    fn position(&mut self) -> Result<HeadPosition<PLANES>, Self::Error>;
}
