//! A drive with the exact two-mass observer, and the numbers that it can be built in.

use driveline::design::{Disturbance, Encoder, Rate, TwoMassDesign};
use driveline::drive::{Config, ConfigOf, Drive, Limits};
use driveline::fault::Faults;
use driveline::fluctuation::{
    CycleConfig, CycleReading, Extreme, Extremes, Fluctuations, FourierSeries, Order, Quality, Ranked, Ripple, Summed,
    Waveform, WaveformConfig,
};
use driveline::machine::{Damping, Inertia, Stiffness, TwoMass};
use driveline::number::{Fixed, Real};
use driveline::observer::{self, TwoMassConfig};
use driveline::sample::Sample;
use driveline::settings::{Bases, Cycle, Screening};

use super::motion::Motion;

/// Bins of the waveform.
pub const BINS: usize = 64;

/// Rated speed (rad/s), 1500 r/min.
pub const RATED: f64 = 157.0;
/// Constant torque of the motor (N m).
pub const TORQUE: f64 = 300.0;
/// Time between ticks (s).
pub const PERIOD: f64 = 1e-4;

/// A resonance of 61 Hz.
const MACHINE: TwoMass = TwoMass::new(Inertia(2.0), Inertia(4.0), Stiffness(2.0e5), Damping(0.0));
/// The load torque may wander by what the largest ripple of these tests takes within a tenth of a second.
const DESIGN: TwoMassDesign = MACHINE.observer(
    Rate::hz(10_000),
    Encoder::lines(2048),
    Disturbance { torque_accuracy: 3.0, load_torque_step: 3000.0, within: 0.1 },
);
const BASES: Bases = Bases::of(&DESIGN, 12_000.0, 250.0);
const SCREENING: Screening =
    Screening { torque: 3000.0, setpoint: 200.0, innovation: 0.05, frozen_turn: 1.5e-3, max_coast: 150 };

pub type Measured<N> = Drive<N, observer::TwoMassObserver, (), (Extremes, Waveform<BINS>)>;
pub type Constants<N> = ConfigOf<Measured<N>>;

/// A number that the drive can be built in.
pub trait Built: Ranked + Summed {
    const NAME: &'static str;
    fn constants(cycle: Cycle, cycles: u32) -> Constants<Self>;
    fn of_torque(torque: f64) -> Self;
}

macro_rules! built {
    ($number:ident, $name:literal, $bases:expr, $of_torque:expr) => {
        impl Built for $number {
            const NAME: &'static str = $name;
            fn constants(cycle: Cycle, cycles: u32) -> Constants<Self> {
                let cycle = CycleConfig::new(cycle, PERIOD, $bases);
                Config {
                    limits: Limits::<$number>::new(&SCREENING, $bases),
                    observer: TwoMassConfig::<$number>::new(&DESIGN, $bases),
                    fluctuation: (cycle, WaveformConfig::new::<BINS>(cycle, cycles)),
                    governor: (),
                    balancer: (),
                }
            }
            fn of_torque(torque: f64) -> Self {
                $of_torque(torque)
            }
        }
    };
}
built!(f32, "f32", Bases::SI, |torque| torque as f32);
built!(f64, "f64", Bases::SI, |torque| torque);
built!(Fixed, "fixed", BASES, |torque| Fixed::from_f64(torque / BASES.torque));

/// Runs a drive along a motion, at least until `done`, and gives it back; no tick may be faulty after the first 0.3 s,
/// in which the observer is caught.
pub fn run<N: Built>(
    config: &Constants<N>,
    motion: &mut Motion,
    ticks: u32,
    mut done: impl FnMut(&mut Measured<N>) -> bool,
) -> Measured<N> {
    let mut drive = Measured::<N>::new(config, motion.encoder());
    for tick in 0..ticks {
        motion.advance(PERIOD);
        let sample = Sample { angle: motion.encoder(), torque: N::of_torque(TORQUE), setpoint: N::ZERO };
        let faults = drive.tick(config, &sample).faults;
        assert!(tick < 3000 || faults == Faults::NONE, "{}: {faults} in tick {tick}", N::NAME);
        if done(&mut drive) {
            return drive;
        }
    }
    drive
}

/// What was calculated in the number's own precision, in double precision.
pub trait InDouble {
    type Double;
    fn in_double(self) -> Self::Double;
}

impl<R: Real> InDouble for FourierSeries<R> {
    type Double = FourierSeries;
    fn in_double(self) -> FourierSeries {
        let orders = self.orders.map(|order| Order { cos: order.cos.into(), sin: order.sin.into() });
        FourierSeries { mean: self.mean.into(), orders }
    }
}

impl<R: Real> InDouble for Fluctuations<R> {
    type Double = Fluctuations;
    fn in_double(self) -> Fluctuations {
        let [max, min] = [self.max, self.min].map(|of| Extreme { speed: of.speed.into(), angle: of.angle.into() });
        Fluctuations {
            deviation: self.deviation.into(),
            ..Fluctuations::of(max, min, (max.speed - min.speed) / self.delta.into())
        }
    }
}

impl<R: Real> InDouble for CycleReading<R> {
    type Double = CycleReading<f64>;
    fn in_double(self) -> CycleReading<f64> {
        CycleReading {
            mean: self.mean.into(),
            change: self.change.map(Into::into),
            duration: self.duration.into(),
            motor: self.motor.in_double(),
            load: self.load.in_double(),
        }
    }
}

impl<R: Real> InDouble for Ripple<R> {
    type Double = Ripple;
    fn in_double(self) -> Ripple {
        let quality = Quality {
            residue: self.quality.residue.into(),
            spread: self.quality.spread.into(),
            trend: self.quality.trend.into(),
            missed: self.quality.missed,
        };
        Ripple {
            mean: self.mean.into(),
            acceleration: self.acceleration.into(),
            speed: self.speed.in_double(),
            motor: self.motor.in_double(),
            cycles: self.cycles,
            quality,
        }
    }
}
