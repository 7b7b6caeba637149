//! State and errors of the balancing task.

use core::fmt;

use super::design::BalancingDesignError;
use crate::balancing::in_run::AbortReason;
use crate::balancing::reading::ReadingFault;
use crate::balancing::tolerance::Verdict;

/// What the balancing task does.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum BalancingState {
    /// The head moves, or the vibration settles after a move.
    Moving,
    /// A reading is being taken.
    Measuring,
    /// The last reading was refused, and another one is being taken.
    Waiting(ReadingFault),
    /// The rotor stands, or is slower than half of its service speed or faster than 1.1 times.
    OffSpeed,
    /// The head has not reached its weights within its time; it is commanded again.
    HeadStuck,
    /// Balanced, as far as the head can; the verdict by the last reading, where the influence is known. It goes on
    /// watching.
    Held(Option<Verdict<f32>>),
    /// Given up for now, with the head at the best weights. It is tried again after a rest, three times, and when the
    /// vibration changes.
    Stopped(AbortReason),
}

/// Why a call of the balancing task failed. It goes on at the next call.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum BalancingFault<H, K> {
    /// A value of the design.
    Design(BalancingDesignError),
    /// The head's own.
    Head(H),
    /// The memory's own: after a power cut less is remembered.
    Memory(K),
    /// A million calls without a tick: [`Drive::vibration`](crate::drive::Drive::vibration) is not called.
    NoVibration,
}

impl<H: fmt::Debug, K: fmt::Debug> fmt::Display for BalancingFault<H, K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            BalancingFault::Design(error) => error.fmt(f),
            BalancingFault::Head(error) => write!(f, "the balancing head failed: {error:?}"),
            BalancingFault::Memory(error) => write!(f, "the record of the balancing was not kept or read: {error:?}"),
            BalancingFault::NoVibration => {
                f.write_str("there are no samples of the vibration: call `Drive::vibration` in every tick")
            }
        }
    }
}

impl<H: fmt::Debug, K: fmt::Debug> core::error::Error for BalancingFault<H, K> {}
