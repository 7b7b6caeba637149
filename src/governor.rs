//! Speed governors: from estimate and setpoint to the torque command.
//!
//! # Terms
//! *Setpoint*: the commanded motor speed. *Automatic reset*: the integral follows the limited torque, and so does not
//! wind up. *Active damping*: motor torque proportional and opposite to the twist rate. *Droop*: fall of
//! the setpoint with the load. *Isochronous*: without droop. *Trip*: a stop that is latched until it is reset.
//! *Load sharing*: the division of one torque among several motors. *Torque bias* (preload): torque of some of them
//! against the others, so that no pinion leaves its flank.
//!
//! | governor | for |
//! |---|---|
//! | [`SpeedLoop`] | continuous operation: proportional, integral, active damping, lags of setpoint and damping |
//! | [`SpeedGovernor`] | composed of parts: droop, feed-forward, limits by a curve, run sequence and trips |
//! | [`InputShaper`] round one of them | a swinging load: the setpoint in parts whose swings cancel |
//! | [`Supervised`] round any of them | a stop where the machine does not follow its commands |
//!
//! [`LoadSharing`] stands behind any of them, where several motors turn one gear.

mod actuator_monitor;
mod backlash_takeup;
mod compensation;
mod input_shaper;
mod limit;
mod load_sharing;
mod loop_filter;
mod sequencer;
mod setpoint;
mod speed_filter;
mod speed_governor;
mod speed_loop;
mod supervision;
mod transport_delay;

pub use actuator_monitor::{ActuatorMonitor, ActuatorMonitorConfig};
pub use backlash_takeup::{BacklashTakeUp, BacklashTakeUpConfig};
pub use compensation::{
    AccelerationFeedback, AccelerationFeedbackConfig, ActiveDamping, ActiveDampingConfig, Compensation, FeedForward,
    FeedForwardConfig, MechanismFeedForward,
};
pub use input_shaper::{InputShaper, InputShaperConfig};
pub use limit::{
    Curve, CurveConfig, CurvePiece, Limit, Slew, SlewConfig, SymmetricLimit, SymmetricLimitConfig, TorqueRange,
    TorqueRangeConfig,
};
pub use load_sharing::{LoadSharing, LoadSharingConfig};
pub use loop_filter::{DampingLag, LagConfig, LoopFilter, SetpointLag, SpeedLag};
pub use sequencer::{HasRunSequence, RunAction, RunRequest, RunState, Sequence, Sequencer, SequencerConfig, Trip};
pub use setpoint::{Barred, BarredConfig, Droop, DroopConfig, SetpointShape, SpeedRange};
pub use speed_filter::{CycleAverage, MovingAverage, MovingAverageConfig, SpeedFilter};
pub use speed_governor::{Gains, SpeedGovernor, SpeedGovernorConfig};
pub use speed_loop::{SpeedLoop, SpeedLoopConfig};
pub(crate) use supervision::TURN;
pub use supervision::{Supervised, SupervisedConfig, SupervisionConfig};
pub use transport_delay::{TransportDelay, TransportDelayConfig};

use crate::fault::Faults;
use crate::number::Number;
use crate::sample::Estimate;

/// The governor of an engine: droop, feed-forward of the load, a torque curve of `POINTS` points, run sequence, and a
/// moving average of the speed over `FIRING` ticks, the interval between two firings.
pub type EngineGovernor<const POINTS: usize, const FIRING: usize> =
    SpeedGovernor<Droop, FeedForward, Curve<POINTS>, Sequencer, MovingAverage<FIRING>>;

/// A speed governor that takes up backlash or a slack rope gently, with [`Machine::TAKE_UP`].
///
/// [`Machine::TAKE_UP`]: crate::configure::Machine::TAKE_UP
pub type TakeUpGovernor = SpeedGovernor<(), (), BacklashTakeUp<SymmetricLimit>>;

/// A controller of the motor's torque, advanced once a tick.
///
/// ```
/// use driveline::{governor::Governor, number::Part, sample::Estimate};
/// /// A governor of one's own: 20 N m s/rad on the error, nothing else. It goes where `SpeedLoop` stands in a drive.
/// #[derive(Default)]
/// struct Proportional(f32);
/// impl Part<f32> for Proportional {
///     type State = Self;
/// }
/// impl Governor<f32> for Proportional {
///     type Config = ();
///     const COMMANDS: bool = true;
///     fn set_setpoint(&mut self, setpoint: f32) { self.0 = setpoint; }
///     fn command(&mut self, _: &(), now: &Estimate<f32>) -> f32 { 20.0 * (self.0 - now.motor_speed) }
///     fn permitted(&self, _: &(), _: &Estimate<f32>, torque: f32) -> f32 { torque }
///     fn start(&mut self, _: &(), now: &Estimate<f32>, _torque: f32) { self.0 = now.motor_speed; }
/// }
/// let mut governor = Proportional::default();
/// governor.set_setpoint(100.0);
/// assert_eq!(governor.command(&(), &Estimate { motor_speed: 95.0, ..Estimate::default() }), 100.0);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no governor in `{N}`",
    note = "the order is `Drive<Number, Observer, Governor, Fluctuation, Balancer>`, with `()` for a part left out"
)]
pub trait Governor<N: Number>: Default {
    /// Its constants, shared and immutable.
    type Config;

    /// Whether it commands the torque. Where it does not, something else does.
    const COMMANDS: bool;

    /// Whether the last tick is to be [judged](Self::judge): at the start of a tick.
    #[inline(always)]
    fn is_to_judge(&self) -> bool {
        false
    }

    /// Judges the last tick by its estimate.
    fn judge(&mut self, _config: &Self::Config, _estimate: &Estimate<N>) {}

    /// Sets a plausible setpoint; it is held until the next.
    fn set_setpoint(&mut self, setpoint: N);

    /// Sets the speed without its ripple, as measured by the fluctuation, `None` where it is unknown: once a tick,
    /// before [`command`](Self::command).
    #[inline(always)]
    fn set_steady_speed(&mut self, _steady_speed: Option<N>) {}

    /// Sets the torque that a mechanism takes at the present angle, as
    /// [`Observer::known_torque`](crate::observer::Observer::known_torque) has it: once a tick, before
    /// [`command`](Self::command).
    #[inline(always)]
    fn set_known_torque(&mut self, _known_torque: N) {}

    /// Sets the torque of the tick that has ended, as the sample reported it, and the innovation of its angle
    /// (2^-32 turn): once a tick, before [`command`](Self::command).
    #[inline(always)]
    fn set_response(&mut self, _config: &Self::Config, _torque: N, _innovation: N) {}

    /// Sets the turn of the motor in a tick against a closed brake (2^-32 turn).
    #[inline(always)]
    fn set_turn_in_hold(&mut self, _config: &Self::Config, _turned: N) {}

    /// Its own faults, which join those of the tick.
    #[inline(always)]
    fn faults(&self) -> Faults {
        Faults::NONE
    }

    /// The torque for the tick that begins.
    fn command(&mut self, config: &Self::Config, estimate: &Estimate<N>) -> N;

    /// The permitted torque nearest to this one, whatever the last; a tripped drive permits none.
    fn permitted(&self, config: &Self::Config, estimate: &Estimate<N>, torque: N) -> N;

    /// Starts anew from the present speed with this [permitted](Self::permitted) torque (bumpless transfer). The
    /// setpoint is zero.
    fn start(&mut self, config: &Self::Config, estimate: &Estimate<N>, torque: N);

    /// Bumpless transfer from the constants `from` to `to`, between two ticks, at the present estimate: the gains
    /// change, the torque does not.
    fn switch(&mut self, _from: &Self::Config, _to: &Self::Config, _estimate: &Estimate<N>) {}

    /// The angle is lost: starts anew without torque, in this and every further tick without it.
    #[inline(always)]
    fn angle_lost(&mut self, config: &Self::Config, estimate: &Estimate<N>) {
        self.start(config, estimate, N::ZERO);
    }
}

/// No governor: the drive observes, and commands no torque.
impl<N: Number> Governor<N> for () {
    type Config = ();

    const COMMANDS: bool = false;

    #[inline(always)]
    fn set_setpoint(&mut self, _setpoint: N) {}

    #[inline(always)]
    fn command(&mut self, _config: &(), _estimate: &Estimate<N>) -> N {
        N::ZERO
    }

    fn permitted(&self, _config: &(), _estimate: &Estimate<N>, torque: N) -> N {
        torque
    }

    fn start(&mut self, _config: &(), _estimate: &Estimate<N>, _torque: N) {}
}
