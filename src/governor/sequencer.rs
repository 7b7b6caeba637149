//! Run and stop sequence of a governed machine, and its trips.

use super::SpeedRange;
use crate::number::Number;
use crate::sample::Estimate;

/// Action of a governor in a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum RunAction {
    /// Govern.
    Govern,
    /// Begin from the present speed without torque, and govern.
    Begin,
    /// Govern with a setpoint of zero.
    Brake,
    /// Command no torque.
    Idle,
}

/// A run sequence; `()` governs always.
pub trait Sequence<N: Number>: Default {
    /// Its constants.
    type Config;

    /// The action of the tick that begins.
    fn action(&mut self, config: &Self::Config, estimate: &Estimate<N>) -> RunAction;

    /// The drive holds the machine by a torque, and governs from there.
    #[inline(always)]
    fn start(&mut self) {}

    /// The angle is lost.
    #[inline(always)]
    fn angle_lost(&mut self) {}

    /// Whether torque may be commanded at all.
    #[inline(always)]
    fn permits(&self) -> bool {
        true
    }
}

/// A governor with a run sequence: it starts, stops and trips.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no run sequence",
    note = "a trip needs one: `SpeedGovernor<(), (), SymmetricLimit, Sequencer>`"
)]
pub trait HasRunSequence {
    /// The run sequence.
    fn sequencer(&self) -> &Sequencer;
    /// The run sequence, to request another state.
    fn sequencer_mut(&mut self) -> &mut Sequencer;
}

/// Always governing.
impl<N: Number> Sequence<N> for () {
    type Config = ();

    #[inline(always)]
    fn action(&mut self, _config: &(), _estimate: &Estimate<N>) -> RunAction {
        RunAction::Govern
    }
}

/// Why a machine was tripped.
///
/// ```
/// use driveline::governor::{RunState, Sequencer, Trip};
/// let mut sequencer = Sequencer::default();
/// assert!(sequencer.trip(Trip::Requested));
/// assert!(!sequencer.trip(Trip::Overspeed)); // the first cause stands
/// assert_eq!(sequencer.state(), RunState::Tripped(Trip::Requested));
/// assert_eq!(Trip::ShaftOverload.to_string(), "shaft overload");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Trip {
    /// Faster than the overspeed limit.
    Overspeed,
    /// Slower than the underspeed limit while running, for longer than is allowed.
    Underspeed,
    /// Turning backwards faster than permitted.
    Reverse,
    /// Shaft torque beyond its limit.
    ShaftOverload,
    /// A sensor was lost: that of the angle, or that of the actuator's position.
    SensorLoss,
    /// Not at speed within the starting time.
    NotStarted,
    /// Requested, as by an emergency stop.
    Requested,
    /// The actuator does not follow its command: it sticks, or its position is measured wrongly.
    Actuator,
}

impl Trip {
    /// Every trip with its name.
    pub const NAMES: [(Trip, &'static str); 8] = [
        (Trip::Overspeed, "overspeed"),
        (Trip::Underspeed, "underspeed"),
        (Trip::Reverse, "reverse"),
        (Trip::ShaftOverload, "shaft overload"),
        (Trip::SensorLoss, "sensor loss"),
        (Trip::NotStarted, "not started"),
        (Trip::Requested, "requested"),
        (Trip::Actuator, "actuator"),
    ];
}

impl core::fmt::Display for Trip {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(Self::NAMES.iter().find(|(trip, _)| trip == self).map_or("", |(_, name)| name))
    }
}

/// State of the run sequence.
///
/// ```
/// use driveline::governor::{RunRequest, RunState, Sequencer};
/// let mut sequencer = Sequencer::default();
/// sequencer.request(RunRequest::Start);
/// // a lamp of the panel
/// let lit = matches!(sequencer.state(), RunState::Starting | RunState::Running | RunState::Braking);
/// assert!(lit);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum RunState {
    /// Without torque, to be started.
    #[default]
    Stopped,
    /// Accelerating to the running range.
    Starting,
    /// Running.
    Running,
    /// Decelerating to standstill.
    Braking,
    /// Without torque, until it is reset.
    Tripped(Trip),
}

/// Requests to [`Sequencer`].
///
/// ```
/// use driveline::governor::{RunRequest, Sequencer};
/// let mut sequencer = Sequencer::default();
/// // a tripped machine starts after a reset alone
/// let [trip, start] = [RunRequest::Trip, RunRequest::Start].map(|request| sequencer.request(request));
/// assert!(trip && !start && sequencer.request(RunRequest::Reset) && sequencer.request(RunRequest::Start));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum RunRequest {
    /// A stopped machine starts at its present speed; a braking one goes on.
    Start,
    /// A starting or running machine brakes to a standstill.
    Stop,
    /// A tripped machine is stopped.
    Reset,
    /// Every machine trips, unless it has tripped already.
    Trip,
}

/// Constants of [`Sequencer`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SequencerConfig<N> {
    /// From underspeed to overspeed.
    pub running: SpeedRange<N>,
    /// From the reverse limit to overspeed.
    pub allowed: SpeedRange<N>,
    /// Largest torque of the shaft, either way (N m).
    pub shaft_torque: N,
    /// The speed below which a braking machine has stopped (rad/s).
    pub standstill: N,
    /// Trip delay of overspeed, reverse rotation and shaft overload: ticks beyond the limit, less those within.
    pub trip_delay: u32,
    /// Trip delay of underspeed: ticks beyond the limit, less those within.
    pub underspeed_delay: u32,
    /// Starting time (ticks).
    pub start: u32,
}

/// The run sequence of a machine, with its trips.
///
/// ```text
/// Stopped -- start --> Starting -- speed in the running range --> Running
///    ^                    |  ^                                       |
///    +-- standstill -- Braking --------------- stop <----------------+
///
/// any of them -- trip --> Tripped(reason) -- reset --> Stopped
/// ```
///
/// A stopped machine is not monitored: it trips only on [request](Sequencer::request) or by [`trip`](Sequencer::trip).
/// Stopped and tripped machines have no torque. A trip keeps its first cause until it is reset.
///
/// ```
/// use driveline::configure::Rating;
/// use driveline::governor::{RunRequest, RunState, Sequence, Sequencer, SequencerConfig, Trip};
/// use driveline::machine::{Speed, Torque};
/// use driveline::{sample::Estimate, settings::{Bases, SequencerSettings}};
/// const RATING: Rating = Rating { torque: Torque(300.0), speed: Speed(150.0), torque_limit: Torque(550.0) };
/// const CONFIG: SequencerConfig<f64> =
///     SequencerConfig::<f64>::new(&SequencerSettings::of(&RATING), 1e-3, Bases::SI);
/// let mut sequencer = Sequencer::default();
/// sequencer.request(RunRequest::Start);
/// let mut tick = |motor_speed| {
///     sequencer.action(&CONFIG, &Estimate { motor_speed, ..Estimate::default() });
///     sequencer.state()
/// };
/// assert_eq!([10.0, 140.0].map(&mut tick), [RunState::Starting, RunState::Running]);
/// // above 110 % of rated speed for longer than 10 ms
/// assert_eq!((0..12).map(|_| tick(166.0)).last(), Some(RunState::Tripped(Trip::Overspeed)));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Sequencer {
    state: RunState,
    fresh: bool,
    outside: u32,
    elapsed: u32,
}

impl Sequencer {
    /// The state.
    pub fn state(&self) -> RunState {
        self.state
    }

    /// Requests another state; `false`, and no change, where the present one does not permit it.
    pub fn request(&mut self, request: RunRequest) -> bool {
        let (state, fresh) = match (request, self.state) {
            (RunRequest::Start, RunState::Stopped) => (RunState::Starting, true),
            (RunRequest::Start, RunState::Braking) => (RunState::Starting, false),
            (RunRequest::Stop, RunState::Starting | RunState::Running) => (RunState::Braking, self.fresh),
            (RunRequest::Reset, RunState::Tripped(_)) => (RunState::Stopped, false),
            (RunRequest::Trip, RunState::Stopped | RunState::Starting | RunState::Running | RunState::Braking) => {
                (RunState::Tripped(Trip::Requested), false)
            }
            _ => return false,
        };
        *self = Sequencer { state, fresh, outside: 0, elapsed: 0 };
        true
    }

    /// Trips for an external cause, such as [`ActuatorMonitor`](super::ActuatorMonitor); `false` where the machine has
    /// already tripped: the first cause stands.
    pub fn trip(&mut self, reason: Trip) -> bool {
        if matches!(self.state, RunState::Tripped(_)) {
            return false;
        }
        self.state = RunState::Tripped(reason);
        true
    }

    /// Counts a tick outside or within the limits; whether the machine has tripped.
    #[inline(always)]
    fn count<N: Number>(
        &mut self,
        config: &SequencerConfig<N>,
        estimate: &Estimate<N>,
        window: &SpeedRange<N>,
    ) -> bool {
        let speed = estimate.motor_speed;
        let (trip, ticks) = if estimate.shaft_torque.exceeds(config.shaft_torque) {
            (Trip::ShaftOverload, config.trip_delay)
        } else if !(speed - window.middle).exceeds(window.half) {
            self.outside = self.outside.saturating_sub(1);
            return false;
        } else if !(speed - config.allowed.middle).exceeds(config.allowed.half) {
            (Trip::Underspeed, config.underspeed_delay)
        } else if speed > config.allowed.middle {
            (Trip::Overspeed, config.trip_delay)
        } else {
            (Trip::Reverse, config.trip_delay)
        };
        self.outside = self.outside.saturating_add(1);
        let tripped = self.outside > ticks;
        if tripped {
            self.state = RunState::Tripped(trip);
        }
        tripped
    }

    /// A tick in any state. Inlined, with the count in each state of its own: the longest path then goes through one.
    #[inline(always)]
    fn other<N: Number>(&mut self, config: &SequencerConfig<N>, estimate: &Estimate<N>) -> RunAction {
        match self.state {
            RunState::Stopped | RunState::Tripped(_) => RunAction::Idle,
            RunState::Running => {
                if self.count(config, estimate, &config.running) {
                    RunAction::Idle
                } else {
                    RunAction::Govern
                }
            }
            RunState::Starting => {
                if self.count(config, estimate, &config.allowed) {
                    return RunAction::Idle;
                }
                self.elapsed = self.elapsed.saturating_add(1);
                if !(estimate.motor_speed - config.running.middle).exceeds(config.running.half) {
                    self.state = RunState::Running;
                } else if self.elapsed > config.start {
                    self.state = RunState::Tripped(Trip::NotStarted);
                    return RunAction::Idle;
                }
                if core::mem::take(&mut self.fresh) { RunAction::Begin } else { RunAction::Govern }
            }
            RunState::Braking => {
                if self.count(config, estimate, &config.allowed) {
                    return RunAction::Idle;
                }
                if !estimate.motor_speed.exceeds(config.standstill) {
                    self.state = RunState::Stopped;
                    return RunAction::Idle;
                }
                // A machine stopped before its first tick still begins at its speed.
                if core::mem::take(&mut self.fresh) { RunAction::Begin } else { RunAction::Brake }
            }
        }
    }
}

impl<N: Number> Sequence<N> for Sequencer {
    type Config = SequencerConfig<N>;

    #[inline(always)]
    fn action(&mut self, config: &SequencerConfig<N>, estimate: &Estimate<N>) -> RunAction {
        if self.state == RunState::Running && self.outside == 0 {
            let outside = (estimate.motor_speed - config.running.middle).exceeds(config.running.half)
                || estimate.shaft_torque.exceeds(config.shaft_torque);
            if !outside {
                return RunAction::Govern;
            }
        }
        self.other(config, estimate)
    }

    fn start(&mut self) {
        if !matches!(self.state, RunState::Tripped(_)) {
            *self = Sequencer { state: RunState::Starting, fresh: false, outside: 0, elapsed: 0 };
        }
    }

    fn angle_lost(&mut self) {
        if !matches!(self.state, RunState::Tripped(_) | RunState::Stopped) {
            self.state = RunState::Tripped(Trip::SensorLoss);
        }
    }

    #[inline(always)]
    fn permits(&self) -> bool {
        !matches!(self.state, RunState::Tripped(_))
    }
}
