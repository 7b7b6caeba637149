//! The balancing head: a device that sets a correction while the rotor turns.

use super::scalar::Complex;

/// Where a head stands.
#[derive(Clone, Copy, Debug, PartialEq)]
// Not logged: the complex numbers of `nalgebra` have no `Format`.
pub enum HeadPosition<const PLANES: usize = 1> {
    /// At these weights (kg m), as measured.
    At([Complex<f32>; PLANES]),
    /// It moves, or its position is not valid yet.
    Moving,
    /// It has no sensor: a move takes [`BalancingDesign::travel`](super::BalancingDesign::travel) at most.
    Unmeasured,
}

/// A balancing head, or an electromagnetic actuator, in `PLANES` planes.
///
/// A weight is a mass times its radius at an angle from the rotor's zero, positive as the rotor's angle (kg m).
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
