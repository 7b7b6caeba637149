//! Inputs and outputs of a tick.

use crate::fault::Faults;

/// One measurement, taken at the beginning of a tick.
///
/// Fixed point has torque and speed per unit of [`Bases::torque`](crate::settings::Bases::torque) and
/// [`Bases::speed`](crate::settings::Bases::speed).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Sample<N> {
    /// Motor angle (2^-32 turn); it wraps, and its zero does not matter.
    pub angle: u32,
    /// Air-gap torque of the motor over the tick that has just ended (N m; per unit in fixed point); positive
    /// accelerates forwards.
    pub torque: N,
    /// Speed setpoint of the motor (rad/s; per unit in fixed point).
    pub setpoint: N,
}

/// The observer's estimate at the beginning of a tick, referred to the motor; per unit of the bases of [`Sample`] in
/// fixed point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Estimate<N> {
    /// Speed of the motor (rad/s; per unit in fixed point).
    pub motor_speed: N,
    /// Torque in the shaft (N m; per unit in fixed point), the softest one of the chain: that of its twist, without the
    /// loss of a gear on either side; positive where the motor drives the load.
    pub shaft_torque: N,
    /// Speed of the load (rad/s; per unit in fixed point).
    pub load_speed: N,
    /// Torque that the load opposes to its motion (N m; per unit in fixed point); positive decelerates.
    pub load_torque: N,
}

/// Output of a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Command<N> {
    /// Torque command for the tick that begins (N m; per unit in fixed point): within the governor's limit, or the
    /// torque of [`crate::drive::Drive::hold`].
    pub torque: N,
    /// Faults of this tick.
    pub faults: Faults,
}
