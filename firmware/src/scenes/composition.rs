//! The hoist's drive with parts left out, to measure the cost of each: an observer alone, with a governor, with a
//! measurement of the fluctuation, and an observer called directly, without a drive.

use driveline::drive::{ConfigOf, Drive};
use driveline::fault::Faults;
use driveline::fluctuation::{Extremes, Waveform};
use driveline::governor::SpeedLoop;
use driveline::number::{Number, Part, StateOf};
use driveline::observer::{GearedObserver, Observer, RigidObserver, SemiImplicitObserver, TwoMassObserver};
use driveline::sample::{Command, Sample};

use super::hoist::Hoist;
use crate::scene::composed::{Beside, Composed, OverWords, output, sample};
use crate::scene::table::variants;
use crate::scene::{FromConfig, Input, Output, Scene};

/// A tick and nothing else: the drive is always at work.
pub struct AtWork;

impl<D: OverWords> Beside<D> for AtWork {
    fn start(_: &mut D, _: &ConfigOf<D>) -> Self {
        AtWork
    }

    #[inline(always)]
    fn tick(&mut self, drive: &mut D, config: &ConfigOf<D>, input: &Input) -> Output {
        let command = drive.tick(config, &sample(input));
        output(&command, &drive.estimate(config))
    }
}

/// A drive of these parts.
pub type Parts<N, O, G = (), F = ()> = Composed<Drive<N, O, G, F>, AtWork>;

/// One mass, observed.
pub type Rigid<N> = Parts<N, RigidObserver>;
/// One mass, governed.
pub type RigidGoverned<N> = Parts<N, RigidObserver, SpeedLoop>;
/// Two masses, semi-implicit step, observed.
pub type SemiImplicit<N> = Parts<N, SemiImplicitObserver>;
/// Two masses, semi-implicit step, governed.
pub type SemiImplicitGoverned<N> = Parts<N, SemiImplicitObserver, SpeedLoop>;
/// Two masses, exact step, observed.
pub type TwoMass<N> = Parts<N, TwoMassObserver>;
/// Two masses, exact step, governed.
pub type TwoMassGoverned<N> = Parts<N, TwoMassObserver, SpeedLoop>;
/// Two masses behind a gear, observed.
pub type Geared<N> = Parts<N, GearedObserver<TwoMassObserver>>;
/// Two masses behind a gear, governed.
pub type GearedGoverned<N> = Parts<N, GearedObserver<TwoMassObserver>, SpeedLoop>;
/// Two masses, and the extremes of the speed.
pub type TwoMassExtremes<N> = Parts<N, TwoMassObserver, (), Extremes>;
/// Two masses, and the waveform of the speed.
pub type TwoMassWaveform<N> = Parts<N, TwoMassObserver, (), Waveform<64>>;
/// Two masses, called by hand.
pub type TwoMassByHand<N> = ByHand<N, TwoMassObserver>;

variants! {
    "rigid-observer": Rigid for Hoist<10_000>;
    "rigid-governed": RigidGoverned for Hoist<10_000>;
    "semi-implicit-observer": SemiImplicit for Hoist<10_000>;
    "semi-implicit-governed": SemiImplicitGoverned for Hoist<10_000>;
    "two-mass-observer": TwoMass for Hoist<10_000>;
    "two-mass-governed": TwoMassGoverned for Hoist<10_000>;
    "two-mass-geared-observer": Geared for Hoist<10_000>;
    "two-mass-geared-governed": GearedGoverned for Hoist<10_000>;
    "two-mass-extremes": TwoMassExtremes for Hoist<10_000>;
    "two-mass-waveform": TwoMassWaveform for Hoist<10_000>;
    "two-mass-by-hand": TwoMassByHand for Hoist<10_000>;
}

// As in the drive, which keeps them to itself.
const NONE_YET: i32 = i32::MIN;
const ONE: i32 = NONE_YET + 1;

/// An observer called directly with the screening of [`driveline::drive`]: the reference for a drive with an observer
/// alone. It follows `Drive::observe` and `Drive::search` line by line.
pub struct ByHand<N: Number + 'static, O: Part<N, State: Observer<N, Config: 'static>> + 'static> {
    config: &'static ConfigOf<Drive<N, O>>,
    observer: O::State,
    torque: N,
    missed: i32,
}

impl<N: Number, O: Part<N, State: Observer<N>>> ByHand<N, O> {
    #[inline(always)]
    fn tick(&mut self, sample: &Sample<N>) -> Command<N> {
        let faults = if self.missed < 0 { self.search(sample) } else { self.observe(sample) };
        Command { torque: N::ZERO, faults }
    }

    #[inline(always)]
    fn observe(&mut self, sample: &Sample<N>) -> Faults {
        let (limits, config) = (&self.config.limits, &self.config.observer);
        let (mut torque, mut faults) = (sample.torque, Faults::NONE);
        if torque.exceeds(limits.torque) {
            torque = self.torque;
            faults |= Faults::TORQUE;
        } else {
            self.torque = torque;
        }
        if sample.setpoint.exceeds(limits.setpoint) {
            faults |= Faults::SETPOINT;
        }
        let missed = self.missed;
        let predicted = self.observer.predict(config, sample.angle, torque);
        let unchanged = sample.angle == self.observer.angle();
        let frozen = unchanged && predicted.turn().exceeds(limits.frozen_turn);
        if frozen || predicted.innovation().exceeds(limits.innovation) {
            faults |= if unchanged { Faults::ANGLE_FROZEN } else { Faults::ANGLE_JUMP };
            self.observer.coast(predicted, sample.angle);
            self.missed = if (missed as u32) < limits.max_coast { missed.wrapping_add(1) } else { NONE_YET };
        } else {
            self.observer.correct(config, predicted, sample.angle);
            if missed != 0 {
                self.missed = missed - 1;
            }
        }
        faults | Faults::from_bits(self.observer.beyond_base())
    }

    #[cold]
    #[inline(never)]
    fn search(&mut self, sample: &Sample<N>) -> Faults {
        let limits = &self.config.limits;
        let mut faults = Faults::ANGLE_JUMP | Faults::ANGLE_LOST;
        let mut torque = sample.torque;
        if torque.exceeds(limits.torque) {
            torque = N::ZERO;
            faults |= Faults::TORQUE;
        }
        let last = self.observer.angle();
        let turned = N::from_angle(sample.angle.wrapping_sub(last) as i32);
        let speed = <StateOf<O, N>>::speed_of_turn(&self.config.observer, turned);
        if sample.angle == last {
            faults = Faults::ANGLE_FROZEN | Faults::ANGLE_LOST;
            self.missed = NONE_YET;
        } else if self.missed == NONE_YET || speed.exceeds(limits.setpoint + limits.setpoint) {
            self.observer.resync(sample.angle);
            self.missed = ONE;
        } else {
            let count = <StateOf<O, N>>::speed_of_turn(&self.config.observer, N::ZERO.less_turn(limits.frozen_turn))
                .magnitude();
            let known = self.observer.estimate(&self.config.observer).motor_speed;
            if (speed - known).exceeds(count) {
                self.observer = <StateOf<O, N>>::steady(&self.config.observer, sample.angle, torque, speed);
            } else {
                self.observer.resync(sample.angle);
            }
            self.missed = limits.max_coast as i32 & i32::MAX;
        }
        self.torque = N::ZERO;
        faults
    }
}

impl<N: Number, O: Part<N, State: Observer<N, Config: 'static>>> FromConfig for ByHand<N, O> {
    type Drive = Drive<N, O>;

    fn from_config(config: &'static ConfigOf<Drive<N, O>>) -> Self {
        ByHand { config, observer: <StateOf<O, N>>::at_rest(&config.observer, 0, N::ZERO), torque: N::ZERO, missed: 0 }
    }
}

impl<N: Number, O: Part<N, State: Observer<N>>> Scene for ByHand<N, O> {
    #[inline(always)]
    fn tick(&mut self, input: &Input) -> Output {
        let command = ByHand::tick(self, &sample(input));
        output(&command, &self.observer.estimate(&self.config.observer))
    }
}
