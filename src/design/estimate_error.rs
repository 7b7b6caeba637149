//! Errors of the three estimates.

use crate::math::{hypot, sqrt};

/// Errors of shaft torque, load speed and load torque (N m, rad/s, N m), rms.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct EstimateError {
    /// Shaft torque (N m).
    pub shaft_torque: f64,
    /// Load speed (rad/s).
    pub load_speed: f64,
    /// Load torque (N m).
    pub load_torque: f64,
}

impl EstimateError {
    pub(super) const fn of(squares: [f64; 3]) -> Self {
        Self { shaft_torque: sqrt(squares[0]), load_speed: sqrt(squares[1]), load_torque: sqrt(squares[2]) }
    }

    /// Both, independent of one another.
    #[must_use]
    pub const fn and(&self, other: &Self) -> Self {
        Self {
            shaft_torque: hypot(self.shaft_torque, other.shaft_torque),
            load_speed: hypot(self.load_speed, other.load_speed),
            load_torque: hypot(self.load_torque, other.load_torque),
        }
    }
}
