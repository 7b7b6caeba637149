//! Compensation torque: feed-forward of the load and of a mechanism, active damping, acceleration feedback.

use crate::number::Number;
use crate::sample::Estimate;

/// Compensation torque added to the loop's; `()` adds none, a tuple adds one after the other.
pub trait Compensation<N: Number>: Default {
    /// Its constants.
    type Config;

    /// Sets the torque that a mechanism takes at the present angle.
    #[inline(always)]
    fn set_known_torque(&mut self, _known_torque: N) {}

    /// `torque` with the steady compensation, which counts for the droop.
    #[inline(always)]
    fn steady(&self, _config: &Self::Config, _estimate: &Estimate<N>, torque: N) -> N {
        torque
    }

    /// `torque` with the transient compensation.
    #[inline(always)]
    fn transient(&self, _config: &Self::Config, _estimate: &Estimate<N>, torque: N) -> N {
        torque
    }

    /// The loop's integral with room for the compensation beside it: two bases in fixed point.
    #[inline(always)]
    fn held(integral: N) -> N {
        integral.saturated()
    }
}

/// Nothing is added.
impl<N: Number> Compensation<N> for () {
    type Config = ();
}

impl<N: Number, A: Compensation<N>, B: Compensation<N>> Compensation<N> for (A, B) {
    type Config = (A::Config, B::Config);

    #[inline(always)]
    fn set_known_torque(&mut self, known_torque: N) {
        self.0.set_known_torque(known_torque);
        self.1.set_known_torque(known_torque);
    }

    #[inline(always)]
    fn steady(&self, config: &Self::Config, estimate: &Estimate<N>, torque: N) -> N {
        self.1.steady(&config.1, estimate, self.0.steady(&config.0, estimate, torque))
    }

    #[inline(always)]
    fn transient(&self, config: &Self::Config, estimate: &Estimate<N>, torque: N) -> N {
        self.1.transient(&config.1, estimate, self.0.transient(&config.0, estimate, torque))
    }

    #[inline(always)]
    fn held(integral: N) -> N {
        A::held(B::held(integral))
    }
}

/// Load feed-forward: a share of the estimated load torque, added before the speed falls.
///
/// The estimate depends on the applied torque. With a slow actuator the observer must be given the torque with the same
/// delay ([`TransportDelay`](super::TransportDelay)), or the feed-forward feeds itself.
///
/// ```
/// use driveline::governor::{Compensation, FeedForward, FeedForwardConfig};
/// use driveline::{sample::Estimate, settings::Bases};
/// // nine tenths of a load of 1000 N m, on 50 N m of the loop
/// const SHARE: FeedForwardConfig<f64> = FeedForwardConfig::<f64>::new(0.9, Bases::SI);
/// let estimate = Estimate { load_torque: 1000.0, ..Estimate::default() };
/// assert_eq!(FeedForward.steady(&SHARE, &estimate, 50.0), 950.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[doc(alias("feed forward", "feedforward"))]
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

    // At most two bases: in saturation the integral stands as far beyond the limit.
    #[inline(always)]
    fn held(integral: N) -> N {
        integral.addable()
    }
}

/// Feed-forward of a mechanism: the torque `J' omega^2/2 + G y'` that its inertia and its weight take at the present
/// angle, from a [`MechanismObserver`](crate::observer::MechanismObserver). The speed stays flat, and the motor gives
/// the ripple. For a flat torque leave it out and take [`CycleAverage`](super::CycleAverage): the speed swings then.
///
/// The droop leaves it out, which is zero in the mean. Home the crank first.
///
/// ```
/// use driveline::governor::{Compensation, MechanismFeedForward};
/// use driveline::sample::Estimate;
/// // in a drive the mechanism's observer gives its torque: J' omega^2/2 with J' = 0.5 kg m2/rad at 20 rad/s
/// let mut feed_forward = MechanismFeedForward::default();
/// feed_forward.set_known_torque(0.5 * 20.0 * 20.0 / 2.0);
/// assert_eq!(feed_forward.transient(&(), &Estimate::default(), 30.0), 130.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct MechanismFeedForward<N = f32> {
    known_torque: N,
}

impl<N: Number> Compensation<N> for MechanismFeedForward<N> {
    type Config = ();

    #[inline(always)]
    fn set_known_torque(&mut self, known_torque: N) {
        self.known_torque = known_torque;
    }

    #[inline(always)]
    fn transient(&self, _config: &(), _estimate: &Estimate<N>, torque: N) -> N {
        torque + self.known_torque
    }
}

/// Active damping: torque against the estimated twist rate, like a damper between motor and load.
///
/// ```
/// use driveline::governor::{ActiveDamping, ActiveDampingConfig, Compensation};
/// use driveline::sample::Estimate;
/// // 8 N m s/rad against a motor that turns 2 rad/s faster than its load
/// const DAMPING: ActiveDampingConfig<f64> = ActiveDampingConfig { damping: -8.0 };
/// let twisting = Estimate { motor_speed: 102.0, load_speed: 100.0, ..Estimate::default() };
/// assert_eq!(ActiveDamping.transient(&DAMPING, &twisting, 50.0), 50.0 - 8.0 * 2.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[doc(alias = "resonance damping")]
pub struct ActiveDamping;

/// Constants of [`ActiveDamping`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ActiveDampingConfig<N: Number> {
    /// Active damping -k_d (N m s/rad), on the twist rate.
    pub damping: N::Coefficient,
}

impl<N: Number> Compensation<N> for ActiveDamping {
    type Config = ActiveDampingConfig<N>;

    #[inline(always)]
    fn transient(&self, config: &ActiveDampingConfig<N>, estimate: &Estimate<N>, torque: N) -> N {
        torque + (estimate.motor_speed - estimate.load_speed).gained::<1>(config.damping)
    }

    // At most a base: in saturation the integral stands as far beyond the limit.
    #[inline(always)]
    fn held(integral: N) -> N {
        integral.addable()
    }
}

/// Acceleration feedback: torque against the estimated acceleration of the load, like a flywheel. It acts when the load
/// has changed, before the speed has, and allows a faster loop with a slow actuator
/// ([`VirtualInertia`](crate::design::VirtualInertia)). At constant speed it is zero, and the droop does not include
/// it.
///
/// The acceleration is the shaft torque less the load torque, over the load's inertia. Use it where the shaft torque
/// has no ripple in every cycle.
///
/// ```
/// use driveline::governor::{AccelerationFeedback, AccelerationFeedbackConfig, Compensation};
/// use driveline::sample::Estimate;
/// // as with a flywheel of half the load's inertia: half of the 200 N m that brake the load are added
/// const FLYWHEEL: AccelerationFeedbackConfig<f64> = AccelerationFeedbackConfig { feedback: -0.5 };
/// let jump = Estimate { shaft_torque: 100.0, load_torque: 300.0, ..Estimate::default() };
/// assert_eq!(AccelerationFeedback.transient(&FLYWHEEL, &jump, 50.0), 150.0);
/// ```
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
        // Limited to twice the base; an operand in fixed point has room for four times.
        let accelerating = (estimate.shaft_torque - estimate.load_torque).saturated();
        torque + accelerating.widened().times(config.feedback)
    }
}
