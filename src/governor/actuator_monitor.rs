//! Whether an actuator is where it was told to be.
//!
//! A rack or a valve follows its command with lags that are known. What its position says is compared with what the
//! commands of the past make of them: where both differ by more than a tolerance, the position is not believed and the
//! expected torque stands in, so that the observer is not misled; where that lasts, the actuator sticks or its sensor is
//! lost, and the machine has to be tripped. Which of the two it is, the torque alone does not tell.
//!
//! | position | what becomes of it |
//! |---|---|
//! | as expected, to the tolerance | believed |
//! | beyond the tolerance: dropped, negated, noisy, stuck | the expected torque instead, [`Faults::TORQUE`]; after the timeout [`Trip::Actuator`] |
//! | no torque at all: NaN, infinite, beyond what the actuator can give | the same, and [`Trip::SensorLoss`] |
//! | frozen at what is still expected | believed: it is right; found when the command moves by more than the tolerance |

use super::Trip;
use crate::fault::Faults;
use crate::number::Number;

/// Watches an actuator of `K` lags in a row, at least one.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ActuatorMonitor<N, const K: usize> {
    /// The torque that each lag has come to.
    expected: [N; K],
    /// Ticks without a position that can be believed, less those with one.
    outside: u32,
    /// The last that was not believed is no torque at all.
    absent: bool,
}

/// Constants of [`ActuatorMonitor`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ActuatorMonitorConfig<N: Number, const K: usize> {
    /// What each lag covers of its way in a tick, `1 - exp(-T/lag)`.
    pub share: [N::Coefficient; K],
    /// Largest difference that is believed \[N m\].
    pub tolerance: N,
    /// Largest torque that the actuator can stand for, either way \[N m\].
    pub max_torque: N,
    /// Ticks beyond the tolerance, less those within, that are ridden through.
    pub timeout: u32,
}

impl<N: Number, const K: usize> ActuatorMonitor<N, K> {
    /// A watch on an actuator that has stood at no torque.
    pub const fn new() -> Self {
        const { assert!(K > 0, "an actuator that is watched has a lag") };
        ActuatorMonitor { expected: [N::ZERO; K], outside: 0, absent: false }
    }

    /// The torque that the actuator's position should stand for \[N m\].
    #[inline(always)]
    pub fn expected(&self) -> N {
        self.expected.last().copied().unwrap_or(N::ZERO)
    }

    /// The torque to believe where the position stands for `measured`, and what is wrong with it.
    #[inline(always)]
    pub fn check(&mut self, config: &ActuatorMonitorConfig<N, K>, measured: N) -> (N, Faults) {
        let expected = self.expected();
        if (measured - expected).exceeds(config.tolerance) {
            // One beyond the timeout: what mends is believed again after as long a time.
            if self.outside <= config.timeout {
                self.outside = self.outside.wrapping_add(1);
            }
            self.absent = measured.exceeds(config.max_torque);
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

    /// Why the machine has to be tripped, for [`Sequencer::trip`](super::Sequencer::trip); none while it need not be.
    #[inline(always)]
    pub fn trip(&self, config: &ActuatorMonitorConfig<N, K>) -> Option<Trip> {
        if self.outside <= config.timeout {
            return None;
        }
        Some(if self.absent { Trip::SensorLoss } else { Trip::Actuator })
    }
}

impl<N: Number, const K: usize> Default for ActuatorMonitor<N, K> {
    fn default() -> Self {
        Self::new()
    }
}
