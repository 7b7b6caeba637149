//! Torque beside the loop's own: the estimated load fed forward, the twist damped, acceleration opposed.

use crate::number::Number;
use crate::sample::Estimate;

/// What adds torque; `()` adds none, a tuple adds one after the other.
pub trait Compensation<N: Number>: Default {
    /// Its constants.
    type Config;

    /// `torque` with what stands as long as the load does, which counts for the droop.
    #[inline(always)]
    fn steady(&self, _config: &Self::Config, _estimate: &Estimate<N>, torque: N) -> N {
        torque
    }

    /// `torque` with what passes.
    #[inline(always)]
    fn transient(&self, _config: &Self::Config, _estimate: &Estimate<N>, torque: N) -> N {
        torque
    }
}

/// Nothing is added.
impl<N: Number> Compensation<N> for () {
    type Config = ();
}

impl<N: Number, A: Compensation<N>, B: Compensation<N>> Compensation<N> for (A, B) {
    type Config = (A::Config, B::Config);

    #[inline(always)]
    fn steady(&self, config: &Self::Config, estimate: &Estimate<N>, torque: N) -> N {
        self.1.steady(&config.1, estimate, self.0.steady(&config.0, estimate, torque))
    }

    #[inline(always)]
    fn transient(&self, config: &Self::Config, estimate: &Estimate<N>, torque: N) -> N {
        self.1.transient(&config.1, estimate, self.0.transient(&config.0, estimate, torque))
    }
}

/// A share of the estimated load torque, so that the loop need not wait for the speed to fall.
///
/// The estimate contains the torque that was given. Where the actuator is late, the observer must be told the torque as
/// late as it acts ([`TransportDelay`](super::TransportDelay)), or what is fed forward feeds itself.
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

impl<N: Number> Compensation<N> for FeedForward {
    type Config = FeedForwardConfig<N>;

    #[inline(always)]
    fn steady(&self, config: &FeedForwardConfig<N>, estimate: &Estimate<N>, torque: N) -> N {
        torque + estimate.load_torque.widened().times(config.share)
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

impl<N: Number> Compensation<N> for ActiveDamping {
    type Config = ActiveDampingConfig<N>;

    #[inline(always)]
    fn transient(&self, config: &ActiveDampingConfig<N>, estimate: &Estimate<N>, torque: N) -> N {
        let twist_rate = (estimate.motor_speed - estimate.load_speed).gain_operand();
        torque + twist_rate.times(config.damping)
    }
}

/// Torque against the estimated acceleration of the load, as a flywheel would give it, by the actuator alone: it begins to
/// act when the load has changed, before the speed has, and lets a loop with a late actuator be quicker
/// ([`VirtualInertia`](crate::design::VirtualInertia)). At constant speed it gives none, and the droop does not count it.
///
/// The acceleration is what the shaft carries beyond the load's torque, over the load's inertia; so it is for a shaft
/// whose torque does not swing in every cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AccelerationFeedback;

/// Constants of [`AccelerationFeedback`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AccelerationFeedbackConfig<N: Number> {
    /// Torque per torque that accelerates the load, negative, on its [widened](Number::widened) value.
    pub feedback: N::Coefficient,
}

impl<N: Number> Compensation<N> for AccelerationFeedback {
    type Config = AccelerationFeedbackConfig<N>;

    #[inline(always)]
    fn transient(&self, config: &AccelerationFeedbackConfig<N>, estimate: &Estimate<N>, torque: N) -> N {
        // Held within twice the base, of which fixed point has four times in an operand.
        let accelerating = (estimate.shaft_torque - estimate.load_torque).saturated();
        torque + accelerating.widened().times(config.feedback)
    }
}
