//! Inputs and outputs of a tick.

use crate::fault::Faults;

/// One measurement, taken at the beginning of a tick.
///
/// Torque and speed are in N m and rad/s for floats, per unit of their bases in fixed point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Sample<N> {
    /// Motor angle, 2^32 to the turn; it wraps, and its zero does not matter.
    pub angle: u32,
    /// Air-gap torque of the motor over the tick that has just ended; positive accelerates forwards.
    pub torque: N,
    /// Speed setpoint of the motor.
    pub setpoint: N,
}

/// The observer's estimate at the beginning of a tick, referred to the motor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Estimate<N> {
    /// Speed of the motor.
    pub motor_speed: N,
    /// Torque in the shaft; positive where the motor drives the load.
    pub shaft_torque: N,
    /// Speed of the load.
    pub load_speed: N,
    /// Torque that the load opposes to its motion; positive decelerates.
    pub load_torque: N,
}

/// Output of a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Command<N> {
    /// Torque command for the tick that begins: within the governor's limit, or the torque of
    /// [`crate::drive::Drive::hold`].
    pub torque: N,
    /// Faults of this tick.
    pub faults: Faults,
}
