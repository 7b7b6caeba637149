//! The limit of the force at a mechanism's tool, from the estimated load torque.

use crate::number::Number;
use crate::sample::Estimate;

/// The limit of the tool's force, without a division in a tick. Beyond it, stop a supervised drive:
/// [`Supervised::stop`](crate::governor::Supervised::stop).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ForceLimitConfig<N> {
    /// Torque of the limit at the largest leverage (N m).
    pub torque: N,
    /// Idle torque (N m), which is not the tool's.
    pub idle: N,
    /// Least leverage, per unit of the largest, at which the force is judged.
    pub least: N,
}

impl<N: Number> ForceLimitConfig<N> {
    /// Whether the tool's force is beyond the limit, from the leverage of a
    /// [`ToolObserver`](crate::observer::ToolObserver) and the estimate of the same tick. Never near a dead centre.
    #[inline(always)]
    pub fn is_exceeded(&self, leverage: N, estimate: &Estimate<N>) -> bool {
        leverage.exceeds(self.least)
            && (estimate.load_torque - self.idle).exceeds(self.torque.scaled(leverage.magnitude()))
    }
}
