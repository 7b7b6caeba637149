//! Modes of a governed machine, and the trips that end them.
//!
//! ```text
//! Stopped -- start --> Starting -- speed in the running range --> Running
//!    ^                    |  ^                                       |
//!    +-- standstill -- Braking --------------- stop <----------------+
//!
//! any of them -- trip --> Tripped(reason) -- reset --> Stopped
//! ```
//!
//! A stopped machine is not watched: it trips only where it is [requested](Sequencer::request) or [commanded](Sequencer::trip). Stopped and tripped machines are given no torque. A trip keeps its first reason until it is reset.

use super::SpeedRange;
use crate::number::Number;
use crate::sample::Estimate;

/// What a governor has to do in a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum RunAction {
    /// Govern.
    Govern,
    /// Begin from the speed that the machine has, without torque, and govern.
    Begin,
    /// Govern towards a standstill.
    Brake,
    /// Command no torque.
    Idle,
}

/// Decides what a governor has to do; `()` has it govern always.
pub trait Sequence<N: Number>: Default {
    /// Its constants.
    type Config;

    /// What there is to do in the tick that begins.
    fn action(&mut self, config: &Self::Config, estimate: &Estimate<N>) -> RunAction;

    /// The drive holds the machine by a torque, to be governed from there.
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

/// Always at work.
impl<N: Number> Sequence<N> for () {
    type Config = ();

    #[inline(always)]
    fn action(&mut self, _config: &(), _estimate: &Estimate<N>) -> RunAction {
        RunAction::Govern
    }
}

/// Why a machine was tripped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Trip {
    /// Faster than the overspeed limit.
    Overspeed,
    /// Slower than the underspeed limit while running, for longer than is allowed.
    Underspeed,
    /// Turning backwards faster than is allowed.
    Reverse,
    /// More torque in the shaft than it may carry.
    ShaftOverload,
    /// A sensor was lost: that of the angle, or that of the actuator's position.
    SensorLoss,
    /// Not at speed in the time that a start may take.
    NotStarted,
    /// Asked for, as by an emergency stop.
    Requested,
    /// The actuator is not where it was told to be: it sticks, or its position reads wrong.
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

/// The mode of a machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum RunState {
    /// Without torque, to be started.
    #[default]
    Stopped,
    /// On its way to the running range.
    Starting,
    /// At work.
    Running,
    /// On its way to a standstill.
    Braking,
    /// Without torque, until it is reset.
    Tripped(Trip),
}

/// What may be asked of [`Sequencer`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum RunRequest {
    /// A stopped machine starts, at the speed that it has; a braking one goes on.
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
    /// Largest torque of the shaft, either way [N m].
    pub shaft_torque: N,
    /// The speed below which a braking machine has stopped [rad/s].
    pub standstill: N,
    /// Ticks of overspeed, of turning backwards or of too much torque, less those without, that do not trip yet.
    pub trip_delay: u32,
    /// Ticks of underspeed, less those without, that do not trip yet.
    pub underspeed_delay: u32,
    /// Ticks that a start may take.
    pub start: u32,
}

/// The modes and trips of a machine.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Sequencer {
    state: RunState,
    fresh: bool,
    outside: u32,
    elapsed: u32,
}

impl Sequencer {
    /// The mode.
    pub fn state(&self) -> RunState {
        self.state
    }

    /// Asks for another mode; `false` where the present one does not allow it, and nothing changes.
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

    /// Trips for a reason that something beside the estimates has found, as [`ActuatorMonitor`](super::ActuatorMonitor); `false` where the
    /// machine has tripped already, and the first reason stands.
    pub fn trip(&mut self, reason: Trip) -> bool {
        if matches!(self.state, RunState::Tripped(_)) {
            return false;
        }
        *self = Sequencer { state: RunState::Tripped(reason), ..Sequencer::default() };
        true
    }

    /// Counts a tick outside the limits, or one within them.
    fn count<N: Number>(&mut self, config: &SequencerConfig<N>, estimate: &Estimate<N>, window: &SpeedRange<N>) {
        let speed = estimate.motor_speed;
        let (trip, ticks) = if estimate.shaft_torque.exceeds(config.shaft_torque) {
            (Trip::ShaftOverload, config.trip_delay)
        } else if !(speed - window.middle).exceeds(window.half) {
            self.outside = self.outside.saturating_sub(1);
            return;
        } else if !(speed - config.allowed.middle).exceeds(config.allowed.half) {
            (Trip::Underspeed, config.underspeed_delay)
        } else if speed > config.allowed.middle {
            (Trip::Overspeed, config.trip_delay)
        } else {
            (Trip::Reverse, config.trip_delay)
        };
        self.outside = self.outside.saturating_add(1);
        if self.outside > ticks {
            self.state = RunState::Tripped(trip);
        }
    }

    /// A tick of any mode but [`RunState::Running`].
    #[cold]
    fn other<N: Number>(&mut self, config: &SequencerConfig<N>, estimate: &Estimate<N>) -> RunAction {
        match self.state {
            RunState::Stopped | RunState::Tripped(_) => return RunAction::Idle,
            RunState::Running => self.count(config, estimate, &config.running),
            RunState::Starting | RunState::Braking => self.count(config, estimate, &config.allowed),
        }
        let action = if self.fresh { RunAction::Begin } else { RunAction::Govern };
        self.fresh = false;
        match self.state {
            RunState::Running => action,
            RunState::Starting => {
                self.elapsed = self.elapsed.saturating_add(1);
                if !(estimate.motor_speed - config.running.middle).exceeds(config.running.half) {
                    self.state = RunState::Running;
                } else if self.elapsed > config.start {
                    self.state = RunState::Tripped(Trip::NotStarted);
                    return RunAction::Idle;
                }
                action
            }
            // One that is stopped before its first tick begins at its speed all the same.
            RunState::Braking if estimate.motor_speed.exceeds(config.standstill) => match action {
                RunAction::Begin => action,
                _ => RunAction::Brake,
            },
            RunState::Braking => {
                self.state = RunState::Stopped;
                RunAction::Idle
            }
            RunState::Stopped | RunState::Tripped(_) => RunAction::Idle,
        }
    }
}

impl<N: Number> Sequence<N> for Sequencer {
    type Config = SequencerConfig<N>;

    #[inline(always)]
    fn action(&mut self, config: &SequencerConfig<N>, estimate: &Estimate<N>) -> RunAction {
        let outside = (estimate.motor_speed - config.running.middle).exceeds(config.running.half)
            || estimate.shaft_torque.exceeds(config.shaft_torque);
        if self.state == RunState::Running && self.outside == 0 && !outside {
            return RunAction::Govern;
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
