//! The reading of a cycle: mean, extremes and delta.

use core::f64::consts::TAU;

use super::SAMPLE;
use crate::fluctuation::CycleConfig;
use crate::math::{atan2, ln, sqrt};

/// A largest or least speed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Extreme {
    /// Speed (rad/s).
    pub speed: f64,
    /// Where in the cycle, from 0 to less than the cycle's angle (rad).
    pub angle: f64,
}

/// How far a speed swings in a cycle [Notes ch. 5].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Fluctuations {
    /// The largest speed.
    pub max: Extreme,
    /// The least speed.
    pub min: Extreme,
    /// (max + min)/2 (rad/s).
    pub arithmetic_mean: f64,
    /// (max - min) over the mean by time.
    pub delta: f64,
    /// (max - min) over the arithmetic mean.
    pub delta_arithmetic: f64,
    /// Standard deviation of both deltas; infinite where the noise of the speed is not known.
    pub deviation: f64,
}

impl Fluctuations {
    /// From the extremes and the mean by time; a delta over no mean at all is infinite or not a number.
    pub fn of(max: Extreme, min: Extreme, mean: f64) -> Self {
        let arithmetic_mean = 0.5 * (max.speed + min.speed);
        let swing = max.speed - min.speed;
        Fluctuations {
            max,
            min,
            arithmetic_mean,
            delta: swing / mean.abs(),
            delta_arithmetic: swing / arithmetic_mean.abs(),
            deviation: f64::INFINITY,
        }
    }
}

/// One cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Reading {
    /// Mean by time (rad/s), of motor and load alike; negative backwards.
    pub mean: f64,
    /// The mean less that of the cycle before (rad/s): the part that is not periodic, which a governor mends and a
    /// flywheel does not.
    pub change: Option<f64>,
    /// How long the cycle took (s).
    pub duration: f64,
    /// The motor.
    pub motor: Fluctuations,
    /// The load.
    pub load: Fluctuations,
}

/// Share of the mean that the largest of independent values has which is added to an extreme: values that follow each
/// other are alike, and the parabola through three of them rises above the largest.
const WIDENED: [f64; 2] = [0.65, 0.35];

impl Fluctuations {
    /// The extremes without what noise of a standard deviation adds to them (rad/s), and the deviation of delta: of so
    /// many samples of a cycle those near an extreme compete, of a wave of once a cycle. The observer's lag is a share
    /// of what it shows.
    fn without_noise(self, mean: f64, [noise, lag]: [f64; 2], samples: f64) -> Self {
        let noise = noise.abs();
        let measured = self.max.speed - self.min.speed;
        let mut added = 0.0;
        for _ in 0..4 {
            let amplitude = (0.5 * measured - WIDENED[0] * added).max(0.25 * noise);
            let share = if noise > 0.0 { acos_share(noise / amplitude) } else { 0.0 };
            added = noise * sqrt((1.64 * ln((samples * share).max(1.0)) - 1.2).max(0.0));
        }
        // no delta is less than none
        let off = (WIDENED[0] * added).min(0.5 * measured);
        let [mut max, mut min] = [self.max, self.min];
        (max.speed, min.speed) = (max.speed - off, min.speed + off);
        let own = 2.0 * noise * noise;
        let unsure = 2.0 * WIDENED[1] * added;
        // beyond half the rate nothing is known
        let lags = if lag.is_finite() { SUMMED * lag * (measured - 2.0 * off) } else { f64::INFINITY };
        let deviation = sqrt(own + unsure * unsure + lags * lags) / mean.abs();
        Fluctuations { deviation, ..Fluctuations::of(max, min, mean) }
    }
}

/// Share of a cycle in which a cosine is within so much of its largest value.
fn acos_share(below: f64) -> f64 {
    let x = below.min(2.0);
    // the angle whose versed sine it is, by its half
    2.0 * atan2(sqrt(0.5 * x), sqrt((1.0 - 0.5 * x).max(0.0))) / core::f64::consts::PI
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
    fn lag(&self, side: usize, frequency: f64) -> f64 {
        let (mut scale, mut above) = (frequency / core::f64::consts::PI, f64::INFINITY);
        for &below in self.lag.get(side).into_iter().flatten() {
            let below = f64::from(below);
            if scale > 1.0 {
                // it grows with the square: in proportion it is not less
                return below + (above - below) * (scale - 1.0);
            }
            (scale, above) = (2.0 * scale, below);
        }
        0.5 * scale * above
    }
}

impl Reading {
    /// The same with the errors of the estimated speeds, of a load torque with orders up to `highest`. Noise makes the
    /// largest speed of a cycle too large and the least too small: they are corrected. The deltas have a deviation by
    /// the noise and by the observer's lag at the highest order; orders beyond it are in no deviation.
    #[must_use]
    pub fn with_errors(self, config: &CycleConfig, errors: &SpeedErrors, highest: usize) -> Self {
        let samples = self.duration / (SAMPLE * config.period);
        let frequency = TAU * highest as f64 / (SAMPLE * samples);
        let of = |side: usize| [errors.noise.get(side).copied().unwrap_or(f64::NAN), errors.lag(side, frequency)];
        Reading {
            motor: self.motor.without_noise(self.mean, of(0), samples),
            load: self.load.without_noise(self.mean, of(1), samples),
            ..self
        }
    }
}
