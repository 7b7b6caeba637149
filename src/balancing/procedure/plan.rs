//! The plan of a procedure.

use crate::balancing::aim::Aim;
use crate::balancing::scalar::{Scalar, real};

/// How a procedure goes.
#[derive(Clone, Copy, Debug, PartialEq)]
// Not logged: the complex numbers of `nalgebra` have no `Format`.
pub struct Plan<T: Scalar, const ROWS: usize, const PLANES: usize> {
    /// Readings of a run.
    pub rows: usize,
    /// Correction planes.
    pub planes: usize,
    /// Whether trial weights stay on when the next one comes.
    pub leave_trials: bool,
    /// How far a speed may be from the baseline's, relative.
    pub speed: T,
    /// The largest acceptable residual, in the unit of the readings; readings weighted with zero do not count.
    pub tolerance: T,
    /// How weights are chosen.
    pub aim: Aim<T, ROWS, PLANES>,
}

impl<T: Scalar, const ROWS: usize, const PLANES: usize> Plan<T, ROWS, PLANES> {
    /// Trial weights taken off again, speeds within a hundredth, least squares, and `tolerance` as the largest
    /// acceptable residual.
    ///
    /// A hundredth is as near as a drive holds its speed; away from a resonance the influence stays the same over it.
    pub fn usual(rows: usize, planes: usize, tolerance: T) -> Self {
        Plan { rows, planes, leave_trials: false, speed: real(0.01), tolerance, aim: Aim::default() }
    }
}
