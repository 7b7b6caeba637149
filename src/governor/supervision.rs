//! Supervision of a drive: a stop where the machine does not follow its commands.
//!
//! In every tick the innovation is compared with its limit, and one of shaft torque, load torque, speed and torque
//! report in turn. A count of ticks beyond a limit, less those within, stops the machine and raises the cause.
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

/// Limits of [`Supervised`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SupervisionConfig<N: Number> {
    /// Largest innovation, either way (2^-32 turn).
    pub innovation: N,
    /// Largest load torque less its recent average, either way (N m).
    pub change: N,
    /// Share of a difference that the recent average covers in four ticks.
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
    /// Share of a difference that the average covers in four ticks.
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
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Supervised<G, N = f32> {
    governor: G,
    innovation: N,
    /// Reported torque of the tick that has ended, and the torque commanded for it.
    reported: N,
    commanded: N,
    /// Average of reported less commanded torque.
    difference: N,
    /// Recent average of the load torque.
    recent: N,
    tick: u32,
    /// The cause with [`Faults::STOPPED`], and a brake that slips.
    raised: Faults,
    /// Whether the motor has turned since the governor started, and neither a count nor a stop is under way.
    calm: bool,
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
            self.calm = false;
        }
    }

    /// Ends a stop: the governor may be started again. Call [`Drive::engage`](crate::drive::Drive::engage) or
    /// [`Drive::hold`](crate::drive::Drive::hold) next.
    pub fn reset(&mut self) {
        (self.raised, self.stop) = (Faults::NONE, Stop::None);
        (self.sudden, self.outside, self.elapsed) = (0, 0, 0);
        (self.difference, self.slipped) = (N::ZERO, None);
    }

    /// Advances the average of the report: every fourth tick.
    #[inline(always)]
    fn differs(&mut self, limits: &SupervisionConfig<N>) -> bool {
        let step = self.reported - self.commanded - self.difference;
        self.difference = self.difference + step.times(limits.share);
        self.difference.exceeds(limits.report)
    }

    /// Advances the recent average of the load torque: every fourth tick.
    #[inline(always)]
    fn changes(&mut self, limits: &SupervisionConfig<N>, load_torque: N) -> bool {
        let change = load_torque - self.recent;
        self.recent = self.recent + change.times(limits.recent);
        change.exceeds(limits.change)
    }
}

const CAUSES: Faults = Faults::from_bits(Faults::SUPERVISION.bits() & !Faults::BRAKE_SLIP.bits());

impl<N: Number, G: Governor<N>> Supervised<G, N> {
    /// A tick with a limit exceeded, a count or a stop under way, or before the motor has turned.
    // The estimate in registers: by reference the tick would store it.
    #[cold]
    #[inline(never)]
    fn supervise(
        &mut self,
        config: &SupervisedConfig<N, G::Config>,
        wanted: N,
        motor_speed: N,
        shaft_torque: N,
        load_speed: N,
        load_torque: N,
    ) -> N {
        let estimate = &Estimate { motor_speed, shaft_torque, load_speed, load_torque };
        let limits = &config.supervision;
        if self.cause().is_none() {
            self.count(limits, estimate);
            if self.cause().is_none() {
                return wanted;
            }
        }
        if self.stop == Stop::None {
            self.begin(limits, estimate);
        }
        let torque = self.stopping(limits, estimate);
        self.governor.permitted(&config.governor, estimate, torque)
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
        let mut torque = self.governor.command(&config.governor, estimate);
        self.tick = self.tick.wrapping_add(1);
        let beyond = match self.tick & 3 {
            0 => {
                estimate.shaft_torque.exceeds(limits.shaft_torque)
                    || (estimate.load_torque - limits.load_torque_middle).exceeds(limits.load_torque_half)
            }
            1 => self.changes(limits, estimate.load_torque),
            2 => estimate.motor_speed.exceeds(limits.speed),
            _ => self.differs(limits),
        };
        if beyond || !self.calm || self.innovation.exceeds(limits.innovation) {
            let Estimate { motor_speed, shaft_torque, load_speed, load_torque } = *estimate;
            torque = self.supervise(config, torque, motor_speed, shaft_torque, load_speed, load_torque);
        }
        self.commanded = torque;
        torque
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
        (self.commanded, self.started, self.difference) = (torque, torque, N::ZERO);
        self.recent = estimate.load_torque;
        (self.turned, self.calm) = (false, false);
    }

    fn angle_lost(&mut self, config: &Self::Config, estimate: &Estimate<N>) {
        self.governor.angle_lost(&config.governor, estimate);
        self.commanded = N::ZERO;
    }
}
