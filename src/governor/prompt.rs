//! Torque beside the loop's own: the estimated load fed forward, the twist damped.

use crate::number::Number;
use crate::sample::Estimate;

/// What adds torque; `()` adds none, a tuple adds one after the other.
pub trait Prompt<N: Number>: Default {
    /// Its constants.
    type Config;

    /// `torque` with what stands as long as the load does, which counts for the droop.
    #[inline(always)]
    fn stand(&self, _config: &Self::Config, _estimate: &Estimate<N>, torque: N) -> N {
        torque
    }

    /// `torque` with what passes.
    #[inline(always)]
    fn oppose(&self, _config: &Self::Config, _estimate: &Estimate<N>, torque: N) -> N {
        torque
    }
}

/// Nothing is added.
impl<N: Number> Prompt<N> for () {
    type Config = ();
}

impl<N: Number, A: Prompt<N>, B: Prompt<N>> Prompt<N> for (A, B) {
    type Config = (A::Config, B::Config);

    #[inline(always)]
    fn stand(&self, config: &Self::Config, estimate: &Estimate<N>, torque: N) -> N {
        self.1.stand(&config.1, estimate, self.0.stand(&config.0, estimate, torque))
    }

    #[inline(always)]
    fn oppose(&self, config: &Self::Config, estimate: &Estimate<N>, torque: N) -> N {
        self.1.oppose(&config.1, estimate, self.0.oppose(&config.0, estimate, torque))
    }
}

/// A share of the estimated load torque, so that the loop need not wait for the speed to fall.
///
/// The estimate contains the torque that was given. Where the actuator is late, the observer must be told the torque as
/// late as it acts ([`Rack`](super::Rack)), or what is fed forward feeds itself.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FeedForward;

/// Constants of [`FeedForward`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FeedForwardConfig<N: Number> {
    /// The share, on the [widened](Number::widened) load torque.
    pub share: N::Coefficient,
}

impl<N: Number> Prompt<N> for FeedForward {
    type Config = FeedForwardConfig<N>;

    #[inline(always)]
    fn stand(&self, config: &FeedForwardConfig<N>, estimate: &Estimate<N>, torque: N) -> N {
        torque.plus(estimate.load_torque.widened().times(config.share))
    }
}

/// Torque against the estimated twist rate, as a damper between motor and load would give it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ActiveDamping;

/// Constants of [`ActiveDamping`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ActiveDampingConfig<N: Number> {
    /// Active damping -k_d [N m s/rad], on the twist rate.
    pub damping: N::Coefficient,
}

impl<N: Number> Prompt<N> for ActiveDamping {
    type Config = ActiveDampingConfig<N>;

    #[inline(always)]
    fn oppose(&self, config: &ActiveDampingConfig<N>, estimate: &Estimate<N>, torque: N) -> N {
        let twist_rate = estimate.motor_speed.minus(estimate.load_speed).gain_operand();
        torque.plus(twist_rate.times(config.damping))
    }
}
