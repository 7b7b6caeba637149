//! Vibration sensors: kind, errors, noise, and the shaft's run-out.

use super::whirl::Motion;
use crate::noise::Noise;

/// Quantity that a sensor measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transducer {
    /// Displacement (m).
    Displacement,
    /// Velocity (m/s).
    Velocity,
    /// Acceleration (m/s2).
    Acceleration,
}

/// A sensor with its faults.
#[derive(Clone, Debug)]
pub struct Faulty {
    kind: Transducer,
    /// Sensitivity over its nominal value.
    gain: f64,
    /// How far the reading lags behind the spin [rad of the spin].
    lag: f64,
    /// Standard deviation of the noise, in the sensor's unit.
    noise: f64,
    /// Run-out (m): order, amplitude, phase (rad) of what a displacement sensor sees of a surface that is not round.
    run_out: Vec<(f64, f64, f64)>,
    /// Largest reading; beyond it the sensor clips.
    range: f64,
    source: Noise,
}

impl Faulty {
    /// A sensor without fault; `seed` is that of its noise.
    #[must_use]
    pub fn new(kind: Transducer, seed: u64) -> Self {
        let range = f64::INFINITY;
        Faulty { kind, gain: 1.0, lag: 0.0, noise: 0.0, run_out: Vec::new(), range, source: Noise::new(seed) }
    }

    /// A sensitivity that is off by this share, such as 0.05, and a phase that is off by this angle (rad), lagging
    /// where positive.
    ///
    /// The phase is that of a zero mark or sensor that stands elsewhere than is thought: the same at every speed.
    #[must_use]
    pub fn error(mut self, share: f64, phase: f64) -> Self {
        self.gain = 1.0 + share;
        self.lag = phase;
        self
    }

    /// White normal noise of this standard deviation, in the sensor's unit.
    #[must_use]
    pub fn noise(mut self, deviation: f64) -> Self {
        self.noise = deviation;
        self
    }

    /// Run-out of an order: amplitude (m) and phase (rad). Sensors of velocity and acceleration, which stand on the
    /// bearing, do not see it.
    #[must_use]
    pub fn run_out(mut self, order: f64, amplitude: f64, phase: f64) -> Self {
        self.run_out.push((order, amplitude, phase));
        self
    }

    /// The largest reading, in the sensor's unit; beyond it the sensor clips.
    #[must_use]
    pub fn range(mut self, range: f64) -> Self {
        self.range = range;
        self
    }

    /// Its reading of a motion at the shaft's `angle` (rad) and `speed` (rad/s).
    ///
    /// The lag is that of what turns with the shaft: `x cos(lag) - x'/Omega sin(lag)` is `Re(X exp(i (phi - lag)))`
    /// for `x = Re(X exp(i phi))`.
    pub fn read(&mut self, motion: &Motion, angle: f64, speed: f64) -> f64 {
        let Motion { displacement, velocity, acceleration } = *motion;
        let (sine, cosine) = self.lag.sin_cos();
        let per_speed = if speed == 0.0 { 0.0 } else { sine / speed };
        let seen = match self.kind {
            Transducer::Displacement => {
                let rough = self.run_out.iter().map(|&(order, size, phase)| size * (order * angle + phase).cos());
                cosine * displacement - per_speed * velocity + rough.sum::<f64>()
            }
            Transducer::Velocity => cosine * velocity - per_speed * acceleration,
            Transducer::Acceleration => cosine * acceleration + sine * speed * velocity,
        };
        let noise = if self.noise > 0.0 { self.noise * self.source.normal() } else { 0.0 };
        (self.gain * seen + noise).clamp(-self.range, self.range)
    }
}
