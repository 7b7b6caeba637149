//! Actuator position monitor.

use super::Trip;
use crate::fault::Faults;
use crate::number::Number;

/// Monitors an actuator of `K` lags in a row, at least one.
///
/// A rack or a valve follows its command with known lags. The measured position is compared with the command behind
/// these lags. Beyond a tolerance the position is rejected and the expected torque replaces it, so that the observer is
/// not misled. Beyond the timeout the actuator sticks or its sensor has failed, and the machine must be tripped. The
/// torque alone does not distinguish the two.
///
/// - **position as expected**, to the tolerance: accepted.
/// - **beyond the tolerance**: dropped, negated, noisy, stuck: the expected torque instead, [`Faults::TORQUE`]; after
///   the timeout [`Trip::Actuator`].
/// - **no torque**: NaN, infinite, beyond the actuator's range: the same, and [`Trip::SensorLoss`].
/// - **frozen at what is still expected**: accepted: it is right; detected when the command moves by more than the
///   tolerance.
///
/// ```
/// use driveline::governor::{ActuatorMonitor, ActuatorMonitorConfig, Trip};
/// // a rack with a lag of 20 ms at 1000 ticks a second; a tenth of 2500 N m is plausible, 0.1 s the patience
/// const CONFIG: ActuatorMonitorConfig<f64, 1> =
///     ActuatorMonitorConfig { share: [0.0488], tolerance: 250.0, max_torque: 3000.0, timeout: 100 };
/// let mut monitor = ActuatorMonitor::new();
/// let mut stuck = |ticks| {
///     for _ in 0..ticks {
///         monitor.check(&CONFIG, 0.0);
///         monitor.advance(&CONFIG, 2500.0);
///     }
///     monitor.trip(&CONFIG)
/// };
/// assert_eq!((stuck(90), stuck(20)), (None, Some(Trip::Actuator)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ActuatorMonitor<N, const K: usize> {
    /// The torque that each lag has come to.
    expected: [N; K],
    /// Ticks without a plausible position, less those with one.
    outside: u32,
    /// Cause by the last rejected one.
    cause: Trip,
}

/// Constants of [`ActuatorMonitor`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ActuatorMonitorConfig<N: Number, const K: usize> {
    /// Share of a step that each lag covers in a tick, `1 - exp(-T/lag)`.
    pub share: [N::Coefficient; K],
    /// Largest plausible difference (N m).
    pub tolerance: N,
    /// Largest torque of the actuator, in either direction (N m).
    pub max_torque: N,
    /// Ticks beyond the tolerance, less those within, before a trip.
    pub timeout: u32,
}

impl<N: Number, const K: usize> ActuatorMonitor<N, K> {
    /// A monitor of an actuator that has been at zero torque.
    pub const fn new() -> Self {
        const { assert!(K > 0, "an actuator that is watched has a lag") };
        ActuatorMonitor { expected: [N::ZERO; K], outside: 0, cause: Trip::Actuator }
    }

    /// The expected torque of the actuator's position (N m).
    #[inline(always)]
    pub fn expected(&self) -> N {
        self.expected.last().copied().unwrap_or(N::ZERO)
    }

    /// The plausible torque for a measured position's torque, and its fault.
    #[inline(always)]
    pub fn check(&mut self, config: &ActuatorMonitorConfig<N, K>, measured: N) -> (N, Faults) {
        let expected = self.expected();
        if (measured - expected).exceeds(config.tolerance) {
            // One beyond the timeout: a recovered position is accepted again after the same time.
            if self.outside <= config.timeout {
                self.outside = self.outside.wrapping_add(1);
            }
            let absent = measured.exceeds(config.max_torque);
            self.cause = if absent { Trip::SensorLoss } else { Trip::Actuator };
            return (expected, Faults::TORQUE);
        }
        self.outside = self.outside.saturating_sub(1);
        (measured, Faults::NONE)
    }

    /// Takes the torque that is commanded for the tick that begins.
    #[inline(always)]
    pub fn advance(&mut self, config: &ActuatorMonitorConfig<N, K>, command: N) {
        let mut input = command;
        for (expected, share) in self.expected.iter_mut().zip(config.share) {
            *expected = *expected + (input - *expected).times(share);
            input = *expected;
        }
    }

    /// The trip to pass to [`Sequencer::trip`](super::Sequencer::trip), if any.
    #[inline(always)]
    pub fn trip(&self, config: &ActuatorMonitorConfig<N, K>) -> Option<Trip> {
        (self.outside > config.timeout).then_some(self.cause)
    }
}

impl<N: Number, const K: usize> Default for ActuatorMonitor<N, K> {
    fn default() -> Self {
        Self::new()
    }
}
