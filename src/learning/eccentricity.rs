//! Eccentricity of the encoder, from the innovation at once a turn.

use super::Finding;
use crate::angle::Synchronous;
use crate::design::{PlacedObserver, TwoMassDesign};
use crate::math::{atan2, hypot, sin_cos};
use crate::number::Fixed;
use crate::observer::{Observer, Prediction};
use crate::sample::Estimate;

/// 2^-32 turns to the radian.
const PER_RADIAN: f64 = 4_294_967_296.0 / core::f64::consts::TAU;
/// Sensitivity below which nothing is learnt.
const LEAST_SENSITIVITY: f64 = 0.1;
/// Change of the speed within a block, as a fraction.
const STEADY_SPEED: f32 = 0.02;
/// Difference of two findings that confirm each other, over the larger one.
const AGREEMENT: f64 = 0.25;
/// Share of a confirmed finding that is taken.
const SHARE: f64 = 0.8;

type Complex = (f64, f64);

const fn times(a: Complex, b: Complex) -> Complex {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

/// Constants of the learning.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct EccentricityConfig {
    /// Time between two ticks (s).
    period: f64,
    /// Trace of the twist's increments, and their determinant.
    twist: [f64; 2],
    /// Poles of the observer, each less one.
    poles: [Complex; 5],
    block: u32,
    /// Largest amplitude (2^-32 turn).
    bound: f64,
}

impl EccentricityConfig {
    /// For an observer of two masses, with amplitudes up to `bound` (rad) and blocks of `time` (s).
    ///
    /// # Panics
    /// At compile time in a constant, for a bound that is not positive or beyond a tenth of a radian, or a time of less
    /// than a hundred ticks.
    pub const fn new(observer: &TwoMassDesign, bound: f64, time: f64) -> Self {
        Self::of_placed(&PlacedObserver::of(observer), bound, time)
    }

    /// As [`new`](Self::new), for a point of a gain schedule.
    pub const fn of_placed(observer: &PlacedObserver, bound: f64, time: f64) -> Self {
        assert!(bound > 0.0 && bound <= 0.1, "the bound of the eccentricity must be above 0 and at most 0.1 rad");
        let block = (time / observer.period) as u32;
        assert!(block >= 100, "a block of the eccentricity must have a hundred ticks or more");
        let step = &observer.step;
        EccentricityConfig {
            period: observer.period,
            twist: [step.n11 + step.n22, step.n11 * step.n22 - step.n12 * step.n21],
            poles: observer.poles,
            block,
            bound: bound * PER_RADIAN,
        }
    }

    /// The part of an error at once a turn that remains in the innovation, at a speed (rad/s).
    pub const fn sensitivity(&self, speed: f64) -> (f64, f64) {
        let theta = speed * self.period;
        let (half, _) = sin_cos(0.5 * theta);
        // z - 1, without cancellation
        let z = (-2.0 * half * half, sin_cos(theta).0);
        let [trace, determinant] = self.twist;
        let square = times(z, z);
        let mut value = (square.0 - trace * z.0 + determinant, square.1 - trace * z.1);
        each!(k, 0..5, {
            if k < 3 {
                value = times(value, z);
            }
            let (re, im) = (z.0 - self.poles[k].0, z.1 - self.poles[k].1);
            let over = 1.0 / (re * re + im * im);
            value = times(value, (re * over, -im * over));
        });
        value
    }
}

/// Numbers with an eccentricity.
pub trait EccentricityNumber: Synchronous {
    /// Units of a sum's growth to 2^-32 turn.
    const UNIT: f64;
    /// The error of an eccentricity (2^-32 turn) in a direction.
    fn error(eccentricity: [i32; 2], direction: [Self::Part; 2]) -> i32;
}

macro_rules! float {
    ($float:ident) => {
        impl EccentricityNumber for $float {
            const UNIT: f64 = 1.0;

            #[inline(always)]
            fn error([a, b]: [i32; 2], [cosine, sine]: [$float; 2]) -> i32 {
                (a as $float * cosine + b as $float * sine) as i32
            }
        }
    };
}

float!(f32);
float!(f64);

impl EccentricityNumber for Fixed {
    const UNIT: f64 = 268_435_456.0;

    // Parts of 2^24, their products with an amplitude of less than 2^27.
    #[inline(always)]
    fn error([a, b]: [i32; 2], [cosine, sine]: [i32; 2]) -> i32 {
        ((i64::from(a) * i64::from(cosine) + i64::from(b) * i64::from(sine)) >> 24) as i32
    }
}

/// An observer behind an eccentric encoder.
///
/// Its constants are those of the observer in it.
///
/// An eccentric encoder reads `phi + a cos(phi) + b sin(phi)` at the angle phi. The observer follows slow errors and
/// leaves fast ones in its innovation: of an error at the frequency theta per tick there remains the part
///
/// ```text
/// S(z) = 1/(1 + C (z - F)^-1 F K) = prod(z - open)/prod(z - closed),   z = e^(j theta)
/// ```
///
/// with the poles of the model and those of the observer. Each tick subtracts the learnt error from the angle and adds
/// the innovation, times cosine and sine of the angle, to two sums. Between the ticks [`EccentricityObserver::learn`]
/// divides these by S at the present speed: amplitude and phase of the remaining error. Without the phase of S the
/// estimate runs away.
///
/// Where S is small the encoder's error cannot be distinguished from the motion, and nothing is learnt. An error of
/// once a turn that stems from the machine is taken for the encoder's, up to the bound.
///
/// ```
#[doc = include_str!("../roll.txt")]
/// use driveline::configure::Configure;
/// use driveline::learning::{EccentricityConfig, EccentricityObserver};
/// use driveline::observer::Observer;
/// const LEARNING: EccentricityConfig = EccentricityConfig::new(&Roll::OBSERVER, 0.002, 0.4);
/// type Behind = EccentricityObserver<TwoMassObserver>;
/// static CONFIG: driveline::observer::TwoMassConfig<f32> = <Behind as Configure<Roll, f32>>::CONFIG;
/// let mut observer = Behind::at_rest(&CONFIG, 0, 0.0);
/// // learnt before the restart: 1 mrad too much at the zero of the angle (2^-32 turn); 3 mrad are beyond the bound
/// observer.restore(&LEARNING, [683_565, 0]);
/// assert!((observer.amplitude_and_phase()[0] - 0.001).abs() < 1e-8);
/// observer.restore(&LEARNING, [3 * 683_565, 0]);
/// assert!((observer.amplitude_and_phase()[0] - 0.002).abs() < 1e-8);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[doc(alias("encoder error", "runout"))]
pub struct EccentricityObserver<O, N: EccentricityNumber = f32> {
    observer: O,
    /// The last accepted angle, as measured.
    measured: u32,
    /// Coefficients of cosine and sine (2^-32 turn).
    eccentricity: [i32; 2],
    sums: [N::Sum; 2],
    ticks: u32,
    learner: Learner,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Learner {
    /// Speed at the beginning of the block.
    speed: f32,
    unconfirmed: Option<Complex>,
}

#[inline(always)]
fn direction<N: EccentricityNumber>(measured: u32) -> [N::Part; 2] {
    N::direction(measured >> 6)
}

impl<N: EccentricityNumber, O> EccentricityObserver<O, N> {
    /// The learnt eccentricity: coefficients of cosine and sine of the measured angle (2^-32 turn).
    pub fn eccentricity(&self) -> [i32; 2] {
        self.eccentricity
    }

    /// Sets an eccentricity that was learnt before, within the bound. The angle must have the zero that it had then: an
    /// absolute encoder, or one that has passed its index.
    pub fn restore(&mut self, config: &EccentricityConfig, eccentricity: [i32; 2]) {
        let [a, b] = eccentricity.map(f64::from);
        self.eccentricity = bounded((a, b), config.bound).0;
        self.begin(0.0);
    }

    fn begin(&mut self, speed: f32) {
        (self.sums, self.ticks, self.learner.speed) = ([N::Sum::default(); 2], 0, speed);
    }

    /// Learns from the ticks since the last block, at the motor's present speed (rad/s): between two ticks, some ten
    /// times a second.
    pub fn learn(&mut self, config: &EccentricityConfig, speed: f32) -> Finding {
        let Learner { speed: began, .. } = self.learner;
        if !((speed - began).abs() <= STEADY_SPEED * began.abs()) {
            self.learner.unconfirmed = None;
            self.begin(if speed.is_finite() { speed } else { 0.0 });
            return Finding::None;
        }
        // Whole turns, nearly: an offset of the innovation leaves less than a fifth of itself after three.
        let turns = f64::from(self.ticks) * f64::from(speed.abs()) * config.period / core::f64::consts::TAU;
        if self.ticks < config.block || turns < 3.0 {
            return Finding::None;
        }
        let zero = N::Sum::default();
        let scale = 2.0 * N::UNIT / f64::from(self.ticks);
        let [p, q] = self.sums.map(|sum| f64::from(N::growth(sum, zero)) * scale);
        self.begin(speed);
        // Backwards the error turns the other way round: the conjugate.
        let (re, im) = config.sensitivity(f64::from(speed.abs()));
        let im = if speed < 0.0 { -im } else { im };
        let square = re * re + im * im;
        if !(square >= LEAST_SENSITIVITY * LEAST_SENSITIVITY) {
            return Finding::None;
        }
        // a - j b = (p - j q)/S
        let (a, minus_b) = times((p, -q), (re / square, -im / square));
        let found = (a, -minus_b);
        let Some(before) = self.learner.unconfirmed.replace(found) else {
            return Finding::Unconfirmed;
        };
        let largest = hypot(found.0, found.1).max(hypot(before.0, before.1));
        if !(hypot(found.0 - before.0, found.1 - before.1) <= AGREEMENT * largest) {
            return Finding::Rejected;
        }
        self.learner.unconfirmed = None;
        let [a, b] = self.eccentricity.map(f64::from);
        let step = 0.5 * SHARE;
        let wanted = (a + step * (found.0 + before.0), b + step * (found.1 + before.1));
        let (eccentricity, is_bounded) = bounded(wanted, config.bound);
        self.eccentricity = eccentricity;
        if is_bounded { Finding::AtBound } else { Finding::Changed }
    }

    /// Amplitude and phase of the learnt error (rad): the encoder reads `amplitude cos(angle - phase)` too much.
    pub fn amplitude_and_phase(&self) -> [f64; 2] {
        let [a, b] = self.eccentricity.map(f64::from);
        [hypot(a, b) / PER_RADIAN, atan2(b, a)]
    }
}

/// Within a circle, and whether it had to be moved there.
fn bounded((a, b): Complex, bound: f64) -> ([i32; 2], bool) {
    let size = hypot(a, b);
    let share = if size > bound { bound / size } else { 1.0 };
    ([(a * share) as i32, (b * share) as i32], size > bound)
}

impl<N: EccentricityNumber, O: Observer<N>> Observer<N> for EccentricityObserver<O, N> {
    type Config = O::Config;
    /// The observer's, the direction of the measured angle, and the corrected angle.
    type States = (O::States, ([N::Part; 2], u32));

    fn steady(config: &O::Config, angle: u32, torque: N, speed: N) -> Self {
        EccentricityObserver {
            observer: O::steady(config, angle, torque, speed),
            measured: angle,
            eccentricity: [0; 2],
            sums: [N::Sum::default(); 2],
            ticks: 0,
            learner: Learner::default(),
        }
    }

    fn restart(&mut self, config: &O::Config, angle: u32, torque: N, speed: N) {
        let corrected = angle.wrapping_sub(N::error(self.eccentricity, direction::<N>(angle)) as u32);
        self.observer.restart(config, corrected, torque, speed);
        self.measured = angle;
        self.learner.unconfirmed = None;
        self.begin(0.0);
    }

    fn switch(&mut self, from: &O::Config, to: &O::Config) {
        self.observer.switch(from, to);
    }

    fn speed_of_turn(config: &O::Config, turned: N) -> N {
        O::speed_of_turn(config, turned)
    }

    fn resync(&mut self, angle: u32) {
        self.observer.resync(angle.wrapping_sub(N::error(self.eccentricity, direction::<N>(angle)) as u32));
        self.measured = angle;
        self.learner.unconfirmed = None;
        self.begin(0.0);
    }

    #[inline(always)]
    fn predict(&self, config: &O::Config, angle: u32, torque: N) -> Prediction<N, Self::States> {
        let direction = direction::<N>(angle);
        let corrected = angle.wrapping_sub(N::error(self.eccentricity, direction) as u32);
        self.observer.predict(config, corrected, torque).with((direction, corrected))
    }

    #[inline(always)]
    fn correct(&mut self, config: &O::Config, predicted: Prediction<N, Self::States>, angle: u32) {
        let (predicted, (direction, corrected)) = predicted.split();
        let [p, q] = self.sums;
        let [cosine, sine] = direction;
        self.sums = [predicted.innovation().added(p, cosine), predicted.innovation().added(q, sine)];
        self.ticks = self.ticks.saturating_add(1);
        self.measured = angle;
        self.observer.correct(config, predicted, corrected);
    }

    #[inline(always)]
    fn coast(&mut self, predicted: Prediction<N, Self::States>, _angle: u32) {
        let (predicted, (_, corrected)) = predicted.split();
        self.observer.coast(predicted, corrected);
    }

    #[inline(always)]
    fn estimate(&self, config: &O::Config) -> Estimate<N> {
        self.observer.estimate(config)
    }

    #[inline(always)]
    fn known_torque(&self, config: &O::Config) -> N {
        self.observer.known_torque(config)
    }

    #[inline(always)]
    fn angle(&self) -> u32 {
        self.measured
    }

    #[inline(always)]
    fn beyond_base(&self) -> u32 {
        self.observer.beyond_base()
    }
}
