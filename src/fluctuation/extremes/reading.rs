//! The reading of a cycle: mean, extremes and delta.

use core::f64::consts::TAU;

use super::SAMPLE;
use crate::fluctuation::CycleConfig;
use crate::number::Real;

/// A largest or least speed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Extreme<R = f64> {
    /// Speed (rad/s).
    pub speed: R,
    /// Where in the cycle, from 0 to less than the cycle's angle (rad).
    pub angle: R,
}

/// How far a speed swings in a cycle [Notes ch. 5].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Fluctuations<R = f64> {
    /// The largest speed.
    pub max: Extreme<R>,
    /// The least speed.
    pub min: Extreme<R>,
    /// (max + min)/2 (rad/s).
    pub arithmetic_mean: R,
    /// (max - min) over the mean by time.
    pub delta: R,
    /// (max - min) over the arithmetic mean.
    pub delta_arithmetic: R,
    /// Standard deviation of both deltas; infinite where the noise of the speed is not known.
    pub deviation: R,
}

impl<R: Real> Fluctuations<R> {
    /// From the extremes and the mean by time; a delta over no mean at all is infinite or not a number.
    pub fn of(max: Extreme<R>, min: Extreme<R>, mean: R) -> Self {
        let arithmetic_mean = R::of(0.5) * (max.speed + min.speed);
        let swing = max.speed - min.speed;
        Fluctuations {
            max,
            min,
            arithmetic_mean,
            delta: swing / mean.abs(),
            delta_arithmetic: swing / arithmetic_mean.abs(),
            deviation: R::INFINITY,
        }
    }
}

/// One cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CycleReading<R> {
    /// Mean by time (rad/s), of motor and load alike; negative backwards.
    pub mean: R,
    /// The mean less that of the cycle before (rad/s): the part that is not periodic, which a governor mends and a
    /// flywheel does not.
    pub change: Option<R>,
    /// How long the cycle took (s).
    pub duration: R,
    /// The motor.
    pub motor: Fluctuations<R>,
    /// The load.
    pub load: Fluctuations<R>,
}

/// Share of the mean that the largest of independent values has which is added to an extreme: values that follow each
/// other are alike, and the parabola through three of them rises above the largest.
const WIDENED: [f64; 2] = [0.65, 0.35];

impl<R: Real> Fluctuations<R> {
    /// The extremes without what noise of a standard deviation adds to them (rad/s), and the deviation of delta: of so
    /// many samples of a cycle those near an extreme compete, of a wave of once a cycle. The observer's lag is a share
    /// of what it shows.
    fn without_noise(self, mean: R, [noise, lag]: [R; 2], samples: R) -> Self {
        let noise = noise.abs();
        let measured = self.max.speed - self.min.speed;
        let mut added = R::ZERO;
        for _ in 0..core::hint::black_box(4) {
            let amplitude = (R::of(0.5) * measured - R::of(WIDENED[0]) * added).max(R::of(0.25) * noise);
            let share = if noise > R::ZERO { acos_share(noise / amplitude) } else { R::ZERO };
            let widest = R::of(1.64) * (samples * share).max(R::ONE).ln() - R::of(1.2);
            added = noise * widest.max(R::ZERO).sqrt();
        }
        // no delta is less than none
        let off = (R::of(WIDENED[0]) * added).min(R::of(0.5) * measured);
        let [mut max, mut min] = [self.max, self.min];
        (max.speed, min.speed) = (max.speed - off, min.speed + off);
        let own = R::of(2.0) * noise * noise;
        let unsure = R::of(2.0 * WIDENED[1]) * added;
        // beyond half the rate nothing is known
        let lags = if lag.is_finite() { R::of(SUMMED) * lag * (measured - R::of(2.0) * off) } else { R::INFINITY };
        let deviation = (own + unsure * unsure + lags * lags).sqrt() / mean.abs();
        Fluctuations { deviation, ..Fluctuations::of(max, min, mean) }
    }
}

/// Share of a cycle in which a cosine is within so much of its largest value: `acos(1 - below)/pi`, within 7e-5 rad
/// (Abramowitz and Stegun, 4.4.45).
fn acos_share<R: Real>(below: R) -> R {
    let x = below.min(R::of(2.0));
    // of the nearer end
    let near = x.min(R::of(2.0) - x);
    let y = R::ONE - near;
    let series = R::of(1.570_728_8) + y * (R::of(-0.212_114_4) + y * (R::of(0.074_261_0) - y * R::of(0.018_729_3)));
    let share = near.sqrt() * series * R::of(core::f64::consts::FRAC_1_PI);
    if x > R::ONE { R::ONE - share } else { share }
}

/// Standard deviation of delta over the largest lag: two deviations are the sum of the orders' amplitudes, which is up
/// to 1.4 times half of their swing.
const SUMMED: f64 = 0.7;

/// Octaves of frequencies that an observer's lag is known in, down from half the rate.
pub(crate) const OCTAVES: usize = 14;

/// Errors of the speeds that an observer shows: their noise and its lag. Made by [`crate::settings`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SpeedErrors {
    /// Standard deviations of the speeds of motor and load (rad/s).
    pub noise: [f64; 2],
    /// Largest error of a periodic speed, over what is shown of it, of motor and load: up to half the rate of the
    /// ticks, up to half of that frequency, and so on.
    pub lag: [[f32; OCTAVES]; 2],
}

impl SpeedErrors {
    /// The lag of one of the two speeds up to a frequency (rad in a tick).
    fn lag<R: Real>(&self, side: usize, frequency: R) -> R {
        let (mut scale, mut above) = (frequency * R::of(core::f64::consts::FRAC_1_PI), R::INFINITY);
        for &below in self.lag.get(side).into_iter().flatten() {
            let below = R::of(below.into());
            if scale > R::ONE {
                // it grows with the square: in proportion it is not less
                return below + (above - below) * (scale - R::ONE);
            }
            (scale, above) = (scale + scale, below);
        }
        R::of(0.5) * scale * above
    }
}

impl<R: Real> CycleReading<R> {
    /// The same with the errors of the estimated speeds, of a load torque with orders up to `highest`. Noise makes the
    /// largest speed of a cycle too large and the least too small: they are corrected. The deltas have a deviation by
    /// the noise and by the observer's lag at the highest order; orders beyond it are in no deviation.
    #[must_use]
    pub fn with_errors(self, config: &CycleConfig, errors: &SpeedErrors, highest: usize) -> Self {
        let samples = self.duration / (R::of(SAMPLE) * R::of(config.period));
        let frequency = R::of(TAU / SAMPLE) * R::count(highest as u32) / samples;
        let of = |side: usize| {
            let noise = errors.noise.get(side).copied().unwrap_or(f64::NAN);
            [R::of(noise), errors.lag(side, frequency)]
        };
        CycleReading {
            motor: self.motor.without_noise(self.mean, of(0), samples),
            load: self.load.without_noise(self.mean, of(1), samples),
            ..self
        }
    }
}
