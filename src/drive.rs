//! One tick through all parts: screen the sample, estimate, measure, govern.
//!
//! A drive is composed by type, `Drive<N, Observer, Fluctuation, Governor, Balancer>`, with `()` for a part that the machine does not need;
//! such a part costs nothing. Configuration stands apart: one [`Config`] may serve many drives.
//!
//! # Bad samples
//! A sample is believed as far as it can be true, and what is not believed is flagged and left out, never taken in:
//!
//! | sample | flag | the tick |
//! |---|---|---|
//! | torque NaN, infinite, beyond its limit | [`Faults::TORQUE`] | takes the torque that was last commanded |
//! | set point NaN, infinite, beyond its limit | [`Faults::REFERENCE`] | keeps the last good one |
//! | angle further from the prediction than the innovation limit | [`Faults::ANGLE_JUMP`] | coasts |
//! | angle unchanged while the motor should have turned | [`Faults::ANGLE_FROZEN`] | coasts |
//! | either for longer than the limit | [`Faults::ANGLE_LOST`] as well | takes the next angle that moves as it comes |
//!
//! A frozen encoder is told from a stalled machine by how far the motor ought to have turned: within that allowance
//! the two look alike, and the estimate of the load torque says so.

use crate::balance::Balancer;
use crate::fault::Faults;
use crate::fluctuation::Fluctuation;
use crate::governor::Governor;
use crate::number::Number;
use crate::observer::Observer;
use crate::sample::{Command, Sample};

/// Limits of what a sample can be.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Limits<N: Number> {
    /// Largest applied torque that is believed [N m].
    pub torque: N,
    /// Largest set point that is believed [rad/s].
    pub reference: N,
    /// Turn per motor speed and tick, as a fraction of the turn after which an angle that has not changed counts as frozen.
    pub unturned: N::Coefficient,
    /// Ticks in a row without a usable angle after which it counts as lost.
    pub missed: u16,
}

/// The constants of a drive.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Config<N: Number, O, F = (), G = (), B = ()> {
    /// Limits of what a sample can be.
    pub limits: Limits<N>,
    /// Constants of the observer.
    pub observer: O,
    /// Constants of the fluctuation's measurement.
    pub fluctuation: F,
    /// Constants of the governor.
    pub governor: G,
    /// Constants of the balancer.
    pub balancer: B,
}

/// The constants of a drive composed of these parts.
pub type ConfigOf<N, O, F = (), G = (), B = ()> = Config<
    N,
    <O as Observer<N>>::Config,
    <F as Fluctuation<N>>::Config,
    <G as Governor<N>>::Config,
    <B as Balancer<N>>::Config,
>;

/// The state of a drive.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Drive<N, O, F = (), G = (), B = ()> {
    observer: O,
    fluctuation: F,
    governor: G,
    balancer: B,
    commanded: N,
    reference: N,
    motor_speed: N,
    unturned: N,
    missed: u16,
    phase: Phase,
}

/// How far the drive has come.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
enum Phase {
    /// No sample yet.
    #[default]
    Fresh,
    /// The governor starts with the next released tick.
    Held,
    /// The governor is at work.
    Released,
}

impl<N, O, F, G, B> Drive<N, O, F, G, B>
where
    N: Number,
    O: Observer<N>,
    F: Fluctuation<N>,
    G: Governor<N>,
    B: Balancer<N>,
{
    /// A drive at rest that has seen nothing yet.
    pub fn new() -> Self {
        Drive {
            observer: O::default(),
            fluctuation: F::default(),
            governor: G::default(),
            balancer: B::default(),
            commanded: N::ZERO,
            reference: N::ZERO,
            motor_speed: N::ZERO,
            unturned: N::ZERO,
            missed: 0,
            phase: Phase::Fresh,
        }
    }

    /// One tick with the governor at work.
    #[inline(always)]
    pub fn tick(&mut self, config: &ConfigOf<N, O, F, G, B>, sample: &Sample<N>) -> Command<N> {
        let mut command = self.observe(config, sample);
        if self.phase != Phase::Released {
            self.governor.start(&config.governor, &command.estimate);
            self.phase = Phase::Released;
        }
        command.torque = self
            .governor
            .command(&config.governor, self.reference, &command.estimate);
        self.commanded = command.torque;
        command
    }

    /// One tick with the governor held: the estimates go on, the torque command is zero, and the next [`Drive::tick`] starts from
    /// what the machine does then.
    #[inline(always)]
    pub fn hold(&mut self, config: &ConfigOf<N, O, F, G, B>, sample: &Sample<N>) -> Command<N> {
        let command = self.observe(config, sample);
        self.phase = Phase::Held;
        self.commanded = N::ZERO;
        command
    }

    /// The fluctuation's measurement.
    pub fn fluctuation(&self) -> &F {
        &self.fluctuation
    }

    /// The governor.
    pub fn governor(&self) -> &G {
        &self.governor
    }

    /// The balancer.
    pub fn balancer(&self) -> &B {
        &self.balancer
    }

    /// Gives the balancer a sample of the vibration, taken with the last angle.
    #[inline(always)]
    pub fn vibration(&mut self, config: &ConfigOf<N, O, F, G, B>, vibration: N) {
        self.balancer
            .measure(&config.balancer, self.observer.angle(), vibration);
    }

    /// The angle that was last believed, 2^32 per turn.
    pub fn angle(&self) -> u32 {
        self.observer.angle()
    }

    #[inline(always)]
    fn observe(&mut self, config: &ConfigOf<N, O, F, G, B>, sample: &Sample<N>) -> Command<N> {
        let limits = &config.limits;
        let mut faults = Faults::NONE;
        if self.phase == Phase::Fresh {
            self.observer.synchronise(sample.angle);
            self.phase = Phase::Held;
        }
        let mut torque = sample.torque;
        if torque.exceeds(limits.torque) {
            torque = self.commanded;
            faults |= Faults::TORQUE;
        }
        if sample.reference.exceeds(limits.reference) {
            faults |= Faults::REFERENCE;
        } else {
            self.reference = sample.reference;
        }
        faults |= self.estimate(config, sample.angle, torque);
        let estimate = self.observer.estimate(&config.observer);
        self.motor_speed = estimate.motor_speed;
        if self.observer.is_saturated() {
            faults |= Faults::SATURATED;
        }
        self.fluctuation
            .measure(&config.fluctuation, self.observer.angle(), &estimate);
        Command {
            torque: N::ZERO,
            estimate,
            faults,
        }
    }

    /// Advances the observer by the angle where it can be true, without it where not.
    #[inline(always)]
    fn estimate(&mut self, config: &ConfigOf<N, O, F, G, B>, angle: u32, torque: N) -> Faults {
        let unchanged = angle == self.observer.angle();
        if unchanged {
            let speed = self.motor_speed.widened();
            self.unturned = self
                .unturned
                .accumulate(&mut { N::CARRY }, config.limits.unturned, speed)
                .saturated();
        } else {
            self.unturned = N::ZERO;
        }
        if self.unturned.exceeds(N::ONE) || self.unturned.is_at_rail() {
            self.observer.coast(&config.observer, torque);
            return self.missed(config.limits.missed, Faults::ANGLE_FROZEN);
        }
        if self.observer.update(&config.observer, angle, torque) {
            self.missed = 0;
            return Faults::NONE;
        }
        if unchanged {
            return self.missed(config.limits.missed, Faults::ANGLE_FROZEN);
        }
        let faults = self.missed(config.limits.missed, Faults::ANGLE_JUMP);
        if faults.contains(Faults::ANGLE_LOST) {
            self.observer.synchronise(angle);
        }
        faults
    }

    /// Counts a tick without a usable angle.
    #[inline(always)]
    fn missed(&mut self, limit: u16, fault: Faults) -> Faults {
        self.missed = self.missed.saturating_add(1);
        if self.missed > limit {
            fault | Faults::ANGLE_LOST
        } else {
            fault
        }
    }
}
