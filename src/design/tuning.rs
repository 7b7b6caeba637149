//! Tuning data of the observer: rate, encoder and disturbance.

use super::Error;
use crate::math::sqrt;

/// Sample rate of the controller.
///
/// ```
/// use driveline::design::Rate;
/// assert_eq!(Rate::hz(10_000).period(), Ok(1e-4));
/// assert!(Rate::hz(0).period().is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Rate(f64);

impl Rate {
    /// A rate in ticks a second.
    #[must_use]
    pub const fn hz(rate: u32) -> Self {
        Self(rate as f64)
    }

    /// A rate from the time between two ticks (s).
    #[must_use]
    pub const fn every(period: f64) -> Self {
        Self(1.0 / period)
    }

    /// Time between two ticks (s).
    ///
    /// # Errors
    /// [`Error::Period`] for a rate that is not positive and finite.
    pub const fn period(self) -> Result<f64, Error> {
        if self.0 > 0.0 && self.0.is_finite() && (1.0 / self.0).is_finite() {
            Ok(1.0 / self.0)
        } else {
            Err(Error::Period)
        }
    }
}

/// An encoder on the motor's shaft: its counts, and its accuracy where a data sheet states one.
///
/// Without an accuracy the only error is the rounding to a count. The observer then follows the last count of the
/// encoder. A fine encoder that is less accurate than its counts makes the estimates noisy: state its accuracy.
///
/// ```
/// use driveline::design::Encoder;
///
/// // 512 signal periods, interpolated to 524,288 counts with 1 % of a period, read within 0.1 us at 314 rad/s
/// const FINE: Encoder = Encoder::counts(524_288).interpolation(512, 0.01).jitter(1e-7, 314.0);
/// let [coarse, counted] = [FINE, Encoder::counts(524_288)].map(|encoder| encoder.variance().unwrap().sqrt());
/// assert!(coarse > 20.0 * counted);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[doc(alias = "resolver")]
pub struct Encoder {
    counts: u64,
    /// Amplitudes of interpolation error and eccentricity (rad).
    pub(super) amplitudes: [f64; 2],
    /// Signal periods on a turn.
    pub(super) periods: u32,
    /// Rms of the turn during the jitter (rad).
    pub(super) jitter: f64,
}

impl Encoder {
    /// An encoder by its lines, each read as four counts.
    #[must_use]
    pub const fn lines(lines: u32) -> Self {
        Self { counts: 4 * lines as u64, amplitudes: [0.0; 2], periods: lines, jitter: 0.0 }
    }

    /// Whether it has fewer than 32 lines, which are rather bits.
    pub(crate) const fn has_few_lines(&self) -> bool {
        self.periods > 1 && self.periods < 32 && self.counts == 4 * self.periods as u64
    }

    /// An encoder or resolver by its counts a turn.
    #[must_use]
    pub const fn counts(counts: u32) -> Self {
        Self { counts: counts as u64, amplitudes: [0.0; 2], periods: 1, jitter: 0.0 }
    }

    /// Adds an interpolation error: its amplitude as a fraction of a signal period, and the signal periods on a turn.
    /// These are the lines of the scale, or 1 for a resolver or a magnetic encoder of one pole pair.
    #[must_use]
    pub const fn interpolation(mut self, periods: u32, error: f64) -> Self {
        self.amplitudes[0] = error * core::f64::consts::TAU / periods as f64;
        self.periods = periods;
        self
    }

    /// Adds an eccentricity: the amplitude of the angle's error once a turn (rad).
    #[must_use]
    pub const fn eccentricity(mut self, amplitude: f64) -> Self {
        self.amplitudes[1] = amplitude;
        self
    }

    /// Read at an uncertain time: its rms deviation (s), and the speed at which it is taken into account (rad/s), as
    /// a rule the rated one.
    #[must_use]
    pub const fn jitter(mut self, deviation: f64, speed: f64) -> Self {
        self.jitter = deviation * speed;
        self
    }

    /// Angle of one count (rad).
    ///
    /// # Errors
    /// [`Error::EncoderLines`] for an encoder of none.
    pub const fn resolution(self) -> Result<f64, Error> {
        if self.counts == 0 { Err(Error::EncoderLines) } else { Ok(core::f64::consts::TAU / self.counts as f64) }
    }

    /// Variance of the measured angle (rad2): that of rounding to a count, `resolution^2/12`, and of the accuracy,
    /// `amplitude^2/2` of each periodic error and the square of the jitter's turn.
    ///
    /// # Errors
    /// As [`resolution`](Self::resolution); [`Error::EncoderAccuracy`].
    pub const fn variance(self) -> Result<f64, Error> {
        let [interpolation, eccentricity] = self.amplitudes;
        let accuracy = 0.5 * (interpolation * interpolation + eccentricity * eccentricity) + self.jitter * self.jitter;
        if !(interpolation >= 0.0 && eccentricity >= 0.0 && self.jitter >= 0.0 && accuracy.is_finite()) {
            return Err(Error::EncoderAccuracy);
        }
        let angle = get!(self.resolution());
        Ok(angle * angle / 12.0 + accuracy)
    }
}

/// How the machine is disturbed, in figures that a commissioning engineer has.
///
/// ```
/// use driveline::design::{Disturbance, Rate};
/// // a hoist whose load comes within a second; its torque is known to 2 N m over a millisecond: the mean of ten ticks
/// const USUAL: Disturbance = Disturbance { torque_accuracy: 0.0, load_torque_step: 100.0, within: 1.0 };
/// const HOIST: Disturbance = USUAL.torque_over(2.0, 1e-3, Rate::hz(10_000));
/// assert!((HOIST.torque_accuracy - 2.0 * 10.0_f64.sqrt()).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Disturbance {
    /// Root mean square of the error of the motor's torque in one tick (N m), taken as independent from tick to tick.
    pub torque_accuracy: f64,
    /// A step of the load torque (N m) that the observer is to have followed ...
    pub load_torque_step: f64,
    /// ... within this time (s).
    pub within: f64,
}

impl Disturbance {
    /// Sets a torque whose mean over `time` (s) is accurate to `accuracy` (N m, rms): white noise of one density at
    /// every rate, `accuracy sqrt(time/T)` in a tick T.
    ///
    /// A `torque_accuracy` of the same size in a tick at a higher rate claims a better torque than it is: constant,
    /// offset and the machine's own deviations do not average out over more ticks.
    #[must_use]
    pub const fn torque_over(mut self, accuracy: f64, time: f64, rate: Rate) -> Self {
        self.torque_accuracy = accuracy * sqrt(time * rate.0);
        self
    }

    /// Variance of the motor's torque in a tick (N2 m2).
    ///
    /// # Errors
    /// [`Error::TorqueAccuracy`].
    pub const fn torque_variance(&self) -> Result<f64, Error> {
        let square = self.torque_accuracy * self.torque_accuracy;
        if self.torque_accuracy > 0.0 && square.is_finite() { Ok(square) } else { Err(Error::TorqueAccuracy) }
    }

    /// Variance that the load torque gains in a tick (N2 m2): `step^2 T / within`.
    ///
    /// The load torque is modelled as a random walk. Its variance grows in proportion to time, so one that has wandered
    /// by a root mean square of `load_torque_step` after the time `within` has an intensity of `step^2/within`; a real
    /// step of that size is then as likely as not, and the filter follows it in about that time.
    ///
    /// # Errors
    /// [`Error::LoadTorqueStep`], [`Error::Within`].
    pub const fn load_torque_variance(&self, period: f64) -> Result<f64, Error> {
        let square = self.load_torque_step * self.load_torque_step;
        if !(self.load_torque_step > 0.0 && square.is_finite()) {
            return Err(Error::LoadTorqueStep);
        }
        let variance = square * period / self.within;
        if self.within > 0.0 && self.within.is_finite() && variance.is_finite() {
            Ok(variance)
        } else {
            Err(Error::Within)
        }
    }
}

/// Variances for the filter's design, in SI units.
#[derive(Clone, Copy)]
pub(super) struct Variances {
    pub(super) period: f64,
    /// Variance of the measured angle.
    pub(super) angle: f64,
    /// Variance of the motor's torque in a tick.
    pub(super) torque: f64,
    /// Variance of the load torque's change in a tick.
    pub(super) load_torque: f64,
}

impl Variances {
    pub(super) const fn of(rate: Rate, encoder: Encoder, disturbance: &Disturbance) -> Result<Self, Error> {
        let period = get!(rate.period());
        let angle = get!(encoder.variance());
        let torque = get!(disturbance.torque_variance());
        Ok(Variances { period, angle, torque, load_torque: get!(disturbance.load_torque_variance(period)) })
    }
}
