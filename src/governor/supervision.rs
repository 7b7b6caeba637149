//! Supervision of a drive: a stop where the machine does not follow its commands.
//!
//! A tick compares one figure with its limit: every other tick the innovation, the ticks between one of the others in
//! turn, so that 16 ticks compare all. Beyond a limit every tick is judged by all of them, at the start of the next. A
//! count of ticks beyond a limit, less those within, stops the machine and raises the cause.
//!
//! | cause | limit | stop |
//! |---|---|---|
//! | [`Faults::LOAD_BLOCKED`] | innovation against motion and shaft torque | by torque |
//! | [`Faults::LOAD_LOST`] | innovation along the shaft torque | by torque |
//! | [`Faults::NOT_FOLLOWED`] | innovation along the motion against the shaft torque, or one that turns over when the stop reverses the torque; load torque | no torque |
//! | [`Faults::OVERSPEED`] | speed of motor or load | by torque |
//! | [`Faults::SHAFT_OVERLOAD`] | shaft torque | no torque |
//! | [`Faults::TORQUE_REPORT`] | average of reported less commanded torque | by torque |
//! | [`Faults::BRAKE_SLIP`] | turn behind a closed brake | none: hold the machine by [`Drive::tick`] |
//!
//! A stop by torque commands the stop torque against the motion, as far as the governor permits it, until the machine
//! stands or turns back; every stop ends without torque. The brake is then to be closed: with
//! [`TRIPPING`](crate::axis::TRIPPING) an [`Axis`](crate::axis::Axis) takes its enable chain back at once. The cause
//! stands until [`Supervised::reset`].
//!
//! The first two causes show at once; within the naming time the stop's own torque tells a machine that follows it from
//! a power stage that gives less than it should.
//!
//! [`Drive::tick`]: crate::drive::Drive::tick

mod stop;

use super::Governor;
use crate::fault::Faults;
use crate::number::Number;
use crate::sample::Estimate;

/// Ticks within which every figure is compared with its limit.
pub(crate) const TURN: i32 = 16;

/// Limits of [`Supervised`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SupervisionConfig<N: Number> {
    /// Largest innovation, either way (2^-32 turn).
    pub innovation: N,
    /// Largest load torque less its recent average, either way (N m).
    pub change: N,
    /// Share of a difference that the recent average covers in 16 ticks.
    pub recent: N::Coefficient,
    /// Middle of the permitted load torques (N m).
    pub load_torque_middle: N,
    /// Half the width of their range (N m).
    pub load_torque_half: N,
    /// Largest torque of the shaft, either way (N m).
    pub shaft_torque: N,
    /// Largest speed, either way (rad/s).
    pub speed: N,
    /// Largest average of reported less commanded torque, either way (N m).
    pub report: N,
    /// Share of a difference that the average covers in 16 ticks.
    pub share: N::Coefficient,
    /// Largest turn behind a closed brake (2^-32 turn).
    pub slip: N,
    /// Change of the torque under which a motor at rest has to turn (N m).
    pub breakaway: N,
    /// Speed below which the motor is at rest (rad/s).
    pub still: N,
    /// Ticks beyond the innovation, less those within, before a stop.
    pub sudden: u32,
    /// Ticks beyond another limit, less those within, before a stop.
    pub lasting: u32,
    /// Ticks of a stop within which its cause is determined.
    pub naming: u32,
    /// Torque of a stop (N m).
    pub stop_torque: N,
    /// Speed below which the machine has stopped (rad/s).
    pub standstill: N,
}

/// Constants of [`Supervised`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SupervisedConfig<N: Number, G> {
    /// Constants of the governor.
    pub governor: G,
    /// Limits.
    pub supervision: SupervisionConfig<N>,
}

/// What a supervised governor commands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
enum Stop {
    /// The governor's torque.
    #[default]
    None,
    /// The stop torque against the motion.
    Torque,
    /// No torque.
    Released,
}

/// A governor under supervision.
///
/// ```
#[doc = include_str!("../roll.txt")]
/// use driveline::{fault::Faults, governor::Supervised};
/// type Watched = Drive<f32, TwoMassObserver, Supervised<SpeedLoop>>;
/// static CONFIG: ConfigOf<Watched> = Watched::configure::<Roll>();
/// let mut drive = Watched::new(&CONFIG, 0);
/// let mut tick = |drive: &mut Watched| drive.tick(&CONFIG, &Sample::si::<Roll>(0, 0.0, 100.0));
/// assert!(tick(&mut drive).torque > 0.0);
/// // a limit switch: no torque at a standstill, the cause stands until it is reset
/// drive.governor_mut().stop(Faults::OVERSPEED);
/// assert_eq!((tick(&mut drive).torque, drive.governor().cause()), (0.0, Faults::OVERSPEED));
/// drive.governor_mut().reset();
/// assert!(drive.governor().cause().is_none());
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Supervised<G, N = f32> {
    governor: G,
    /// Innovation and reported torque of the tick that has ended.
    innovation: N,
    reported: N,
    /// Torque that was commanded for the tick with which a report is compared, and while every tick is judged for the
    /// one that follows.
    commanded: N,
    following: N,
    /// Average of reported less commanded torque.
    difference: N,
    /// Recent average of the load torque.
    recent: N,
    /// Counts down the ticks; its remainder by [`TURN`] is the figure that a tick compares. Below 1 every tick is judged:
    /// a limit is exceeded, a count or a stop is under way, or the motor has not turned since the governor started.
    turn: i32,
    /// The same while every tick is judged.
    meanwhile: i32,
    /// The cause with [`Faults::STOPPED`], and a brake that slips.
    raised: Faults,
    /// Whether the motor has turned since the governor started.
    turned: bool,
    stop: Stop,
    /// Whether the motor was ahead of its prediction, and whether it turned forwards, when the stop began.
    ahead: bool,
    forwards: bool,
    /// Torque from which the governor started.
    started: N,
    sudden: u32,
    outside: u32,
    elapsed: u32,
    /// Turn behind the closed brake; `None` before the first tick of a hold.
    slipped: Option<N>,
}

impl<G, N: Number> Supervised<G, N> {
    /// The governor.
    pub fn governor(&self) -> &G {
        &self.governor
    }

    /// The governor, between two ticks.
    pub fn governor_mut(&mut self) -> &mut G {
        &mut self.governor
    }

    /// The cause of the stop; [`Faults::NONE`] while the machine is followed. Two of them are a pair that the motor's
    /// side cannot tell apart.
    pub fn cause(&self) -> Faults {
        self.raised & CAUSES
    }

    /// Stops the machine for a cause that is known from elsewhere, such as a limit switch, from the next tick on; one of
    /// [`Faults::SUPERVISION`]. The first cause stands.
    pub fn stop(&mut self, cause: Faults) {
        if self.cause().is_none() {
            self.raised |= cause & CAUSES;
            self.turn = 0;
        }
    }

    /// Ends a stop: the governor may be started again. Call [`Drive::engage`](crate::drive::Drive::engage) or
    /// [`Drive::hold`](crate::drive::Drive::hold) next.
    pub fn reset(&mut self) {
        (self.raised, self.stop) = (Faults::NONE, Stop::None);
        (self.sudden, self.outside, self.elapsed) = (0, 0, 0);
        (self.difference, self.slipped) = (N::ZERO, None);
    }

    /// Advances the average of the report: once a turn.
    #[inline(always)]
    fn average_report(&mut self, limits: &SupervisionConfig<N>) {
        let step = self.reported - self.commanded - self.difference;
        self.difference = self.difference + step.times(limits.share);
    }

    /// Advances the recent average of the load torque: once a turn.
    #[inline(always)]
    fn average_load(&mut self, limits: &SupervisionConfig<N>, load_torque: N) {
        self.recent = self.recent + (load_torque - self.recent).times(limits.recent);
    }
}

/// Ticks to the end of a turn in which the averages advance; the torque is kept in the one before the latter.
const AVERAGE_LOAD: i32 = 11;
const AVERAGE_REPORT: i32 = 2;

const CAUSES: Faults = Faults::from_bits(Faults::SUPERVISION.bits() & !Faults::BRAKE_SLIP.bits());

impl<N: Number, G: Governor<N>> Supervised<G, N> {
    /// Judges the last tick: a limit exceeded, a count or a stop under way, or before the motor has turned.
    fn judge_tick(&mut self, limits: &SupervisionConfig<N>, estimate: &Estimate<N>) {
        self.meanwhile = self.meanwhile.wrapping_sub(1);
        match self.meanwhile & (TURN - 1) {
            AVERAGE_LOAD => self.average_load(limits, estimate.load_torque),
            AVERAGE_REPORT => self.average_report(limits),
            _ => {}
        }
        self.commanded = self.following;
        if self.cause().is_none() && self.count(limits, estimate) {
            self.turn = i32::MAX - (TURN - 1) + (self.meanwhile & (TURN - 1));
        }
        if !self.cause().is_none() {
            if self.stop == Stop::None {
                self.begin(limits, estimate);
            }
            self.stopping(limits, estimate);
        }
    }

    /// The torque of a tick that is judged: the governor's, or the stop's.
    #[inline(always)]
    fn judged(&mut self, config: &SupervisedConfig<N, G::Config>, wanted: N, estimate: &Estimate<N>) -> N {
        let torque = match self.stop {
            Stop::None => wanted,
            Stop::Released => N::ZERO,
            Stop::Torque => {
                let most = config.supervision.stop_torque;
                let torque = if self.forwards { -most } else { most };
                self.governor.permitted(&config.governor, estimate, torque)
            }
        };
        if self.turn >= 0 {
            self.meanwhile = self.turn;
        }
        (self.following, self.turn) = (torque, 0);
        torque
    }
}

impl<N: Number, G: Governor<N>> Governor<N> for Supervised<G, N> {
    type Config = SupervisedConfig<N, G::Config>;

    const COMMANDS: bool = G::COMMANDS;

    #[inline(always)]
    fn set_setpoint(&mut self, setpoint: N) {
        self.governor.set_setpoint(setpoint);
    }

    #[inline(always)]
    fn set_steady_speed(&mut self, steady_speed: Option<N>) {
        self.governor.set_steady_speed(steady_speed);
    }

    #[inline(always)]
    fn set_known_torque(&mut self, known_torque: N) {
        self.governor.set_known_torque(known_torque);
    }

    #[inline(always)]
    fn set_response(&mut self, config: &Self::Config, torque: N, innovation: N) {
        self.governor.set_response(&config.governor, torque, innovation);
        self.reported = torque;
        self.innovation = innovation;
    }

    #[inline(always)]
    fn is_to_judge(&self) -> bool {
        self.turn == 0 || self.governor.is_to_judge()
    }

    fn judge(&mut self, config: &Self::Config, estimate: &Estimate<N>) {
        self.governor.judge(&config.governor, estimate);
        self.judge_tick(&config.supervision, estimate);
    }

    fn set_turn_in_hold(&mut self, config: &Self::Config, turned: N) {
        let slipped = self.slipped.map_or(N::ZERO, |slipped| slipped + turned);
        self.slipped = Some(slipped);
        if slipped.exceeds(config.supervision.slip) {
            self.raised |= Faults::BRAKE_SLIP;
        }
    }

    #[inline(always)]
    fn faults(&self) -> Faults {
        self.raised | self.governor.faults()
    }

    #[inline(always)]
    fn command(&mut self, config: &Self::Config, estimate: &Estimate<N>) -> N {
        let limits = &config.supervision;
        let torque = self.governor.command(&config.governor, estimate);
        self.turn = self.turn.wrapping_sub(1);
        let beyond = self.turn < 0
            || match self.turn & (TURN - 1) {
                15 => estimate.shaft_torque.exceeds(limits.shaft_torque),
                13 => (estimate.load_torque - limits.load_torque_middle).exceeds(limits.load_torque_half),
                AVERAGE_LOAD => {
                    self.average_load(limits, estimate.load_torque);
                    false
                }
                9 => (estimate.load_torque - self.recent).exceeds(limits.change),
                7 => estimate.motor_speed.exceeds(limits.speed),
                5 => estimate.load_speed.exceeds(limits.speed),
                3 => {
                    self.commanded = torque;
                    false
                }
                AVERAGE_REPORT => {
                    self.average_report(limits);
                    false
                }
                1 => self.difference.exceeds(limits.report),
                0 | 4 | 6 | 8 | 10 | 12 | 14 => self.innovation.exceeds(limits.innovation),
                _ => false,
            };
        if beyond { self.judged(config, torque, estimate) } else { torque }
    }

    fn switch(&mut self, from: &Self::Config, to: &Self::Config, estimate: &Estimate<N>) {
        self.governor.switch(&from.governor, &to.governor, estimate);
    }

    fn permitted(&self, config: &Self::Config, estimate: &Estimate<N>, torque: N) -> N {
        if self.stop == Stop::Released {
            return N::ZERO;
        }
        self.governor.permitted(&config.governor, estimate, torque)
    }

    fn start(&mut self, config: &Self::Config, estimate: &Estimate<N>, torque: N) {
        self.governor.start(&config.governor, estimate, torque);
        (self.commanded, self.following, self.started) = (torque, torque, torque);
        self.difference = N::ZERO;
        self.recent = estimate.load_torque;
        (self.turned, self.turn) = (false, 0);
    }

    fn angle_lost(&mut self, config: &Self::Config, estimate: &Estimate<N>) {
        self.governor.angle_lost(&config.governor, estimate);
        (self.commanded, self.following) = (N::ZERO, N::ZERO);
    }
}
