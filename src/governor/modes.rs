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
//! A stopped machine is not watched: it trips only where it is [asked](Modes::ask) to or [told](Modes::trip). Stopped and tripped machines are given no torque. A trip keeps its first reason until it is reset.

use super::Window;
use crate::number::Number;
use crate::sample::Estimate;

/// What a governor has to do in a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Duty {
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
pub trait Supervisor<N: Number>: Default {
    /// Its constants.
    type Config;

    /// What there is to do in the tick that begins.
    fn duty(&mut self, config: &Self::Config, estimate: &Estimate<N>) -> Duty;

    /// The drive holds the machine by a torque, to be governed from there.
    #[inline(always)]
    fn start(&mut self) {}

    /// The angle is lost.
    #[inline(always)]
    fn lose(&mut self) {}

    /// Whether torque may be commanded at all.
    #[inline(always)]
    fn permits(&self) -> bool {
        true
    }
}

/// Always at work.
impl<N: Number> Supervisor<N> for () {
    type Config = ();

    #[inline(always)]
    fn duty(&mut self, _config: &(), _estimate: &Estimate<N>) -> Duty {
        Duty::Govern
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
    Asked,
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
        (Trip::Asked, "asked for"),
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
pub enum Mode {
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

/// What may be asked of [`Modes`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Request {
    /// A stopped machine starts, at the speed that it has; a braking one goes on.
    Start,
    /// A starting or running machine brakes to a standstill.
    Stop,
    /// A tripped machine is stopped.
    Reset,
    /// Every machine trips, unless it has tripped already.
    Trip,
}

/// Constants of [`Modes`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ModesConfig<N> {
    /// From underspeed to overspeed.
    pub running: Window<N>,
    /// From the reverse limit to overspeed.
    pub allowed: Window<N>,
    /// Largest torque of the shaft, either way [N m].
    pub shaft_torque: N,
    /// The speed below which a braking machine has stopped [rad/s].
    pub standstill: N,
    /// Ticks of overspeed, of turning backwards or of too much torque, less those without, that do not trip yet.
    pub prompt: u32,
    /// Ticks of underspeed, less those without, that do not trip yet.
    pub patient: u32,
    /// Ticks that a start may take.
    pub start: u32,
}

/// The modes and trips of a machine.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Modes {
    mode: Mode,
    fresh: bool,
    outside: u32,
    elapsed: u32,
}

impl Modes {
    /// The mode.
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// Asks for another mode; `false` where the present one does not allow it, and nothing changes.
    pub fn ask(&mut self, request: Request) -> bool {
        let (mode, fresh) = match (request, self.mode) {
            (Request::Start, Mode::Stopped) => (Mode::Starting, true),
            (Request::Start, Mode::Braking) => (Mode::Starting, false),
            (Request::Stop, Mode::Starting | Mode::Running) => (Mode::Braking, self.fresh),
            (Request::Reset, Mode::Tripped(_)) => (Mode::Stopped, false),
            (Request::Trip, Mode::Stopped | Mode::Starting | Mode::Running | Mode::Braking) => {
                (Mode::Tripped(Trip::Asked), false)
            }
            _ => return false,
        };
        *self = Modes { mode, fresh, outside: 0, elapsed: 0 };
        true
    }

    /// Trips for a reason that something beside the estimates has found, as [`ActuatorWatch`](super::ActuatorWatch); `false` where the
    /// machine has tripped already, and the first reason stands.
    pub fn trip(&mut self, reason: Trip) -> bool {
        if matches!(self.mode, Mode::Tripped(_)) {
            return false;
        }
        *self = Modes { mode: Mode::Tripped(reason), ..Modes::default() };
        true
    }

    /// Counts a tick outside the limits, or one within them.
    fn count<N: Number>(&mut self, config: &ModesConfig<N>, estimate: &Estimate<N>, window: &Window<N>) {
        let speed = estimate.motor_speed;
        let (trip, ticks) = if estimate.shaft_torque.exceeds(config.shaft_torque) {
            (Trip::ShaftOverload, config.prompt)
        } else if !speed.minus(window.middle).exceeds(window.half) {
            self.outside = self.outside.saturating_sub(1);
            return;
        } else if !speed.minus(config.allowed.middle).exceeds(config.allowed.half) {
            (Trip::Underspeed, config.patient)
        } else if speed > config.allowed.middle {
            (Trip::Overspeed, config.prompt)
        } else {
            (Trip::Reverse, config.prompt)
        };
        self.outside = self.outside.saturating_add(1);
        if self.outside > ticks {
            self.mode = Mode::Tripped(trip);
        }
    }

    /// A tick of any mode but [`Mode::Running`].
    #[cold]
    fn other<N: Number>(&mut self, config: &ModesConfig<N>, estimate: &Estimate<N>) -> Duty {
        match self.mode {
            Mode::Stopped | Mode::Tripped(_) => return Duty::Idle,
            Mode::Running => self.count(config, estimate, &config.running),
            Mode::Starting | Mode::Braking => self.count(config, estimate, &config.allowed),
        }
        let duty = if self.fresh { Duty::Begin } else { Duty::Govern };
        self.fresh = false;
        match self.mode {
            Mode::Running => duty,
            Mode::Starting => {
                self.elapsed = self.elapsed.saturating_add(1);
                if !estimate.motor_speed.minus(config.running.middle).exceeds(config.running.half) {
                    self.mode = Mode::Running;
                } else if self.elapsed > config.start {
                    self.mode = Mode::Tripped(Trip::NotStarted);
                    return Duty::Idle;
                }
                duty
            }
            // One that is stopped before its first tick begins at its speed all the same.
            Mode::Braking if estimate.motor_speed.exceeds(config.standstill) => match duty {
                Duty::Begin => duty,
                _ => Duty::Brake,
            },
            Mode::Braking => {
                self.mode = Mode::Stopped;
                Duty::Idle
            }
            Mode::Stopped | Mode::Tripped(_) => Duty::Idle,
        }
    }
}

impl<N: Number> Supervisor<N> for Modes {
    type Config = ModesConfig<N>;

    #[inline(always)]
    fn duty(&mut self, config: &ModesConfig<N>, estimate: &Estimate<N>) -> Duty {
        let outside = estimate.motor_speed.minus(config.running.middle).exceeds(config.running.half)
            || estimate.shaft_torque.exceeds(config.shaft_torque);
        if self.mode == Mode::Running && self.outside == 0 && !outside {
            return Duty::Govern;
        }
        self.other(config, estimate)
    }

    fn start(&mut self) {
        if !matches!(self.mode, Mode::Tripped(_)) {
            *self = Modes { mode: Mode::Starting, fresh: false, outside: 0, elapsed: 0 };
        }
    }

    fn lose(&mut self) {
        if !matches!(self.mode, Mode::Tripped(_) | Mode::Stopped) {
            self.mode = Mode::Tripped(Trip::SensorLoss);
        }
    }

    #[inline(always)]
    fn permits(&self) -> bool {
        !matches!(self.mode, Mode::Tripped(_))
    }
}
