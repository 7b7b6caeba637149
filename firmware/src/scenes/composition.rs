//! The hoist's drive with parts left out, to measure what each costs: an observer alone, with a governor, with a measurement of the fluctuation,
//! and an observer that is called by hand, without a drive.

use core::marker::PhantomData;

use driveline::drive::{Config, ConfigOf, Drive, Limits};
use driveline::fault::Faults;
use driveline::fluctuation::{CycleConfig, Extremes, Fluctuation, Waveform, WaveformConfig};
use driveline::governor::{Governor, SpeedLoop, SpeedLoopConfig};
use driveline::number::{Fixed, Number};
use driveline::observer::{
    GearedConfig, GearedObserver, Observer, RigidConfig, RigidObserver, SemiImplicitConfig, SemiImplicitObserver,
    TwoMassConfig, TwoMassObserver,
};
use driveline::sample::{Command, Sample};
use driveline::settings::{Bases, Cycle};

use super::hoist::{BASES, GEAR, LOAD_SHARE, REDUCED, SETTINGS, observer, rigid, screening, speed_loop};
use crate::scene::governed::output;
use crate::scene::{Input, Output, Scene};

const RATE_HZ: u32 = 10_000;

/// The parts of a drive and their constants.
pub trait Composition: 'static {
    /// What it calculates with.
    type Number: Number + 'static;
    /// What it estimates with.
    type Observer: Observer<Self::Number>;
    /// What it measures the speed's fluctuation with, `()` for nothing.
    type Fluctuation: Fluctuation<Self::Number>;
    /// What it governs with, `()` for nothing.
    type Governor: Governor<Self::Number>;
    /// Scene, number, parts and rate.
    const NAME: &'static str;
    /// The constants.
    const CONFIG: &'static ConfigOf<Drive<Self::Number, Self::Observer, Self::Fluctuation, Self::Governor>>;
}

/// A number, an observer, a governor and a measurement of the fluctuation, with the hoist's constants.
pub struct Of<N, O, G, F = ()>(PhantomData<(N, O, G, F)>);

/// A drive of these parts.
pub struct Composed<C: Composition> {
    // By reference: folded into the code, the constants cost more instructions than loaded from a table.
    config: &'static ConfigOf<Drive<C::Number, C::Observer, C::Fluctuation, C::Governor>>,
    drive: Drive<C::Number, C::Observer, C::Fluctuation, C::Governor>,
}

impl<C: Composition> Scene for Composed<C> {
    const NAME: &'static str = C::NAME;
    const RATE_HZ: u32 = RATE_HZ;

    fn new() -> Self {
        Composed { config: C::CONFIG, drive: Drive::new(C::CONFIG, 0) }
    }

    #[inline(always)]
    fn tick(&mut self, input: &Input) -> Output {
        let command = self.drive.tick(self.config, &sample(input));
        output(&command, &self.drive.estimate(self.config))
    }
}

#[inline(always)]
fn sample<N: Number>(input: &Input) -> Sample<N> {
    let word = N::from_word;
    Sample { angle: input.angle, torque: word(input.torque), setpoint: word(input.setpoint) }
}

macro_rules! compositions {
    ($number:ident, $text:literal, $limits:expr, $governor:expr, $($name:literal: $observer:ty = $config:expr;)+) => {$(
        impl Composition for Of<$number, $observer, ()> {
            type Number = $number;
            type Observer = $observer;
            type Fluctuation = ();
            type Governor = ();
            const NAME: &'static str = concat!("composition/", $text, "/", $name, "-observer/10000");
            const CONFIG: &'static ConfigOf<Drive<$number, $observer>> =
                &Config { limits: $limits, observer: $config, fluctuation: (), governor: (), balancer: () };
        }

        impl Composition for Of<$number, $observer, SpeedLoop<$number>> {
            type Number = $number;
            type Observer = $observer;
            type Fluctuation = ();
            type Governor = SpeedLoop<$number>;
            const NAME: &'static str = concat!("composition/", $text, "/", $name, "-governed/10000");
            const CONFIG: &'static ConfigOf<Drive<$number, $observer, (), SpeedLoop<$number>>> =
                &Config { limits: $limits, observer: $config, fluctuation: (), governor: $governor, balancer: () };
        }
    )+};
}

const PERIOD: f64 = 1.0 / RATE_HZ as f64;

/// A turn of the motor, and a waveform over 16 of them.
const fn waveform(bases: Bases) -> WaveformConfig {
    WaveformConfig::new::<64>(CycleConfig::new(Cycle::TURN, PERIOD, bases), 16)
}

macro_rules! measured {
    ($number:ident, $text:literal, $limits:expr, $observer:expr;
        $($name:literal: $fluctuation:ty = $config:expr;)+) => {$(
        impl Composition for Of<$number, TwoMassObserver<$number>, (), $fluctuation> {
            type Number = $number;
            type Observer = TwoMassObserver<$number>;
            type Fluctuation = $fluctuation;
            type Governor = ();
            const NAME: &'static str = concat!("composition/", $text, "/two-mass-", $name, "/10000");
            const CONFIG: &'static ConfigOf<Drive<$number, TwoMassObserver<$number>, $fluctuation>> = &Config {
                limits: $limits,
                observer: $observer,
                fluctuation: $config,
                governor: (),
                balancer: (),
            };
        }
    )+};
}

measured! {
    f32, "f32", Limits::<f32>::new(&screening(RATE_HZ), Bases::SI), TwoMassConfig::<f32>::new(&observer(&REDUCED, RATE_HZ), Bases::SI);
    "extremes": Extremes<f32> = waveform(Bases::SI).cycle;
    "waveform": Waveform<f32, 64> = waveform(Bases::SI);
}

measured! {
    Fixed, "fixed", Limits::<Fixed>::new(&screening(RATE_HZ), BASES),
    TwoMassConfig::<Fixed>::new(&observer(&REDUCED, RATE_HZ), BASES);
    "extremes": Extremes<Fixed> = waveform(BASES).cycle;
    "waveform": Waveform<Fixed, 64> = waveform(BASES);
}

compositions! {
    f32, "f32", Limits::<f32>::new(&screening(RATE_HZ), Bases::SI), SpeedLoopConfig::<f32>::new(&speed_loop(RATE_HZ), SETTINGS, Bases::SI),
    "rigid": RigidObserver<f32> = RigidConfig::<f32>::new(&rigid(RATE_HZ), LOAD_SHARE, Bases::SI);
    "semi-implicit": SemiImplicitObserver<f32> = SemiImplicitConfig::<f32>::new(&observer(&REDUCED, RATE_HZ), Bases::SI);
    "two-mass": TwoMassObserver<f32> = TwoMassConfig::<f32>::new(&observer(&REDUCED, RATE_HZ), Bases::SI);
    "two-mass-geared": GearedObserver<TwoMassObserver<f32>> = GearedConfig::<f32, _>::new(
        TwoMassConfig::<f32>::new(&observer(&REDUCED, RATE_HZ), Bases::SI), &GEAR, PERIOD, Bases::SI
    );
}

compositions! {
    Fixed, "fixed", Limits::<Fixed>::new(&screening(RATE_HZ), BASES),
    SpeedLoopConfig::<Fixed>::new(&speed_loop(RATE_HZ), SETTINGS, BASES),
    "rigid": RigidObserver<Fixed> = RigidConfig::<Fixed>::new(&rigid(RATE_HZ), LOAD_SHARE, BASES);
    "semi-implicit": SemiImplicitObserver<Fixed> = SemiImplicitConfig::<Fixed>::new(&observer(&REDUCED, RATE_HZ), BASES);
    "two-mass": TwoMassObserver<Fixed> = TwoMassConfig::<Fixed>::new(&observer(&REDUCED, RATE_HZ), BASES);
    "two-mass-geared": GearedObserver<TwoMassObserver<Fixed>> = GearedConfig::<Fixed, _>::new(
        TwoMassConfig::<Fixed>::new(&observer(&REDUCED, RATE_HZ), BASES), &GEAR, PERIOD, BASES
    );
}

// As in the drive, which keeps them to itself.
const NONE_YET: i32 = i32::MIN;
const ONE: i32 = NONE_YET + 1;

/// An observer called by hand with the screening of [`driveline::drive`], without a drive: what a drive of nothing but an observer is
/// measured against. It follows `Drive::observe` and `Drive::search` line by line.
pub struct ByHand<N: Number + 'static, O: Observer<N, Config: 'static> + 'static> {
    config: &'static ConfigOf<Drive<N, O>>,
    observer: O,
    torque: N,
    missed: i32,
}

impl<N: Number, O: Observer<N>> ByHand<N, O> {
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
        let speed = O::speed_of_turn(&self.config.observer, turned);
        if sample.angle == last {
            faults = Faults::ANGLE_FROZEN | Faults::ANGLE_LOST;
            self.missed = NONE_YET;
        } else if self.missed == NONE_YET || speed.exceeds(limits.setpoint + limits.setpoint) {
            self.observer.resync(sample.angle);
            self.missed = ONE;
        } else {
            let count = O::speed_of_turn(&self.config.observer, N::ZERO.less_turn(limits.frozen_turn)).magnitude();
            let known = self.observer.estimate(&self.config.observer).motor_speed;
            if (speed - known).exceeds(count) {
                self.observer = O::steady(&self.config.observer, sample.angle, torque, speed);
            } else {
                self.observer.resync(sample.angle);
            }
            self.missed = limits.max_coast as i32 & i32::MAX;
        }
        self.torque = N::ZERO;
        faults
    }
}

macro_rules! by_hand {
    ($number:ident, $text:literal) => {
        impl Scene for ByHand<$number, TwoMassObserver<$number>> {
            const NAME: &'static str = concat!("composition/", $text, "/two-mass-by-hand/10000");
            const RATE_HZ: u32 = RATE_HZ;

            fn new() -> Self {
                let config = <Of<$number, TwoMassObserver<$number>, ()> as Composition>::CONFIG;
                let observer = Observer::<$number>::at_rest(&config.observer, 0, <$number as Number>::ZERO);
                ByHand { config, observer, torque: <$number as Number>::ZERO, missed: 0 }
            }

            #[inline(always)]
            fn tick(&mut self, input: &Input) -> Output {
                let command = ByHand::tick(self, &sample(input));
                output(&command, &self.observer.estimate(&self.config.observer))
            }
        }
    };
}

by_hand!(f32, "f32");
by_hand!(Fixed, "fixed");
