//! The limit of the force at a mechanism's tool, from the estimated load torque.

use crate::number::Number;
use crate::sample::Estimate;

/// The limit of the tool's force, without a division in a tick. Beyond it, stop a supervised drive:
/// [`Supervised::stop`](crate::governor::Supervised::stop).
///
/// ```
/// use driveline::{observer::ForceLimitConfig, sample::Estimate};
/// // 400 kN on a largest leverage of 0.1 m, an idle torque of 500 N m
/// const LIMIT: ForceLimitConfig<f64> = ForceLimitConfig { torque: 40_000.0, idle: 500.0, least: 0.1 };
/// let pressing = Estimate { load_torque: 25_500.0, ..Estimate::default() };
/// // 25 kN m are 250 kN there; at half of the leverage they are 500 kN
/// assert!(!LIMIT.is_exceeded(1.0, &pressing) && LIMIT.is_exceeded(0.5, &pressing));
/// ```
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
