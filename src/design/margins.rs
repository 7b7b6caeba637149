//! Stability margins of a sampled loop, from its frequency response.

use super::complex::{Complex, over, scaled};
use super::late_loop::{LateLoop, NARROWEST};
use super::polynomial::Polynomial;
use crate::math::{atan2, exp, hypot, ln, sin_cos};

/// How far a loop is from instability.
///
/// ```
/// use driveline::design::{Actuator, LoadFeedForward, Margins, Rate};
/// use driveline::machine::{Damping, Inertia, Stiffness, TwoMass};
/// const STIFF: TwoMass = TwoMass::new(Inertia(4.0), Inertia(8.0), Stiffness(5.0e7), Damping(6.0e4));
/// const VALVE: Actuator = Actuator { delay: 0.0, lag: 0.1 };
/// let Margins { phase, delay, crossover, .. } =
///     STIFF.governor(Rate::hz(10_000), VALVE, 3.0, LoadFeedForward::NONE).margins(&STIFF);
/// // the symmetrical optimum of 3: atan 3 - atan 1/3 = 53 degrees, which are a dead time of phase over crossover
/// assert!((phase.to_degrees() - 53.13).abs() < 0.5 && (delay * crossover / phase - 1.0).abs() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Margins {
    /// Factor by which the gain may grow; infinite where no growth destabilises.
    pub gain_up: f64,
    /// Factor by which the gain may shrink, below 1; 0 where no loss destabilises.
    pub gain_down: f64,
    /// Smallest phase margin over all crossings of gain 1 (rad).
    pub phase: f64,
    /// Smallest dead time more that destabilises (s): over all crossings, the phase to -180 degrees over the
    /// frequency.
    pub delay: f64,
    /// Highest frequency at which the gain crosses 1 (rad/s).
    pub crossover: f64,
    /// Smallest distance of the response from -1; over 0.5 is sound.
    pub modulus: f64,
}

impl Margins {
    /// Nothing seen yet.
    pub(super) const NONE: Self = Self {
        gain_up: f64::INFINITY,
        gain_down: 0.0,
        phase: f64::INFINITY,
        delay: f64::INFINITY,
        crossover: 0.0,
        modulus: f64::INFINITY,
    };

    /// The smaller of each.
    pub(super) const fn and(&self, other: &Self) -> Self {
        Self {
            gain_up: self.gain_up.min(other.gain_up),
            gain_down: self.gain_down.max(other.gain_down),
            phase: self.phase.min(other.phase),
            delay: self.delay.min(other.delay),
            crossover: self.crossover.max(other.crossover),
            modulus: self.modulus.min(other.modulus),
        }
    }
}

/// An open loop, positive where the feedback opposes.
#[derive(Clone, Copy)]
// A value of a constant evaluation, made once and never stored.
#[allow(clippy::large_enum_variant)]
pub(super) enum OpenLoop {
    /// In closed form, with dead time.
    Late(LateLoop),
    /// Sampled.
    Ratio(CutLoop),
}

/// A loop round one machine, cut at the torque on it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CutLoop {
    pub(super) numerator: Polynomial,
    pub(super) denominator: Polynomial,
    pub(super) period: f64,
}

impl CutLoop {
    /// Response at a frequency (rad/s), as real and imaginary part: the torque that the drive gives against one that is
    /// added where the loop is cut. Its margins are [`ClosedLoop::margins`](super::ClosedLoop::margins).
    #[must_use]
    pub const fn response(&self, frequency: f64) -> (f64, f64) {
        // z - 1 without cancellation
        let (half, cosine) = sin_cos(0.5 * frequency * self.period);
        let delta = (-2.0 * half * half, 2.0 * half * cosine);
        over(self.numerator.at(delta), self.denominator.at(delta))
    }
}

impl OpenLoop {
    /// Response at a frequency (rad/s).
    pub(super) const fn response(&self, frequency: f64) -> Complex {
        match self {
            Self::Late(open) => open.response(frequency),
            Self::Ratio(open) => open.response(frequency),
        }
    }

    /// Lowers the margins found to what a range of frequencies (rad/s) shows, with the loop times each of the gains. The
    /// steps are in proportion to the distance from `about`.
    pub(super) const fn sweep<const N: usize>(
        &self,
        found: &mut Margins,
        gains: [f64; N],
        about: f64,
        [from, to]: [f64; 2],
        points: u32,
    ) {
        let factor = exp(ln((to - about) / (from - about)) / points as f64);
        let mut low = from;
        let mut before = self.response(low);
        each!(point, 0..points, {
            let high = if point + 1 == points { to } else { about + (low - about) * factor };
            let after = self.response(high);
            each!(k, 0..N, {
                self.look(found, gains[k], [low, high], [scaled(gains[k], before), scaled(gains[k], after)]);
            });
            low = high;
            before = after;
        });
    }

    /// The same about a resonance (rad/s), ever finer towards it: a lightly damped shaft turns the response within its
    /// damping. 25 steps a decade pass such a circle in steps of a twentieth of a radian at most.
    pub(super) const fn sweep_about<const N: usize>(
        &self,
        found: &mut Margins,
        gains: [f64; N],
        resonance: f64,
        nyquist: f64,
    ) {
        let beside = NARROWEST * resonance;
        let wide = (0.1 * resonance).min(0.9 * (nyquist - resonance));
        if wide > beside {
            self.sweep(found, gains, resonance, [resonance - wide, resonance - beside], 150);
            self.sweep(found, gains, 0.0, [resonance - beside, resonance + beside], 10);
            self.sweep(found, gains, resonance, [resonance + beside, resonance + wide], 150);
        }
    }

    /// Lowers the margins found to what a step of the frequency shows.
    const fn look(&self, found: &mut Margins, gain: f64, [low, high]: [f64; 2], [before, after]: [Complex; 2]) {
        // a root only where it may be the least
        let square = (1.0 + after.0) * (1.0 + after.0) + after.1 * after.1;
        if square < found.modulus * found.modulus * (1.0 + 1e-9) {
            found.modulus = hypot(1.0 + after.0, after.1).min(found.modulus);
        }
        if (before.1 < 0.0) != (after.1 < 0.0) {
            let crossing = scaled(gain, self.response(self.bisect(low, high, gain, true)));
            let size = -crossing.0;
            // A sign change through a pole or through the positive axis is no crossing of -180 degrees.
            if size > 0.0 && crossing.1.abs() < 1e-3 * size {
                if size < 1.0 && 1.0 / size < found.gain_up {
                    found.gain_up = 1.0 / size;
                }
                if size > 1.0 && 1.0 / size > found.gain_down {
                    found.gain_down = 1.0 / size;
                }
            }
        }
        if is_small(before) != is_small(after) {
            let frequency = self.bisect(low, high, gain, false);
            let crossing = scaled(gain, self.response(frequency));
            let phase = atan2(-crossing.1, -crossing.0).abs();
            let lag = atan2(crossing.1, crossing.0) + core::f64::consts::PI;
            if lag / frequency < found.delay {
                found.delay = lag / frequency;
            }
            if phase < found.phase {
                found.phase = phase;
            }
            if frequency > found.crossover {
                found.crossover = frequency;
            }
        }
    }

    /// Frequency between two at which the imaginary part changes sign, or the gain passes 1.
    const fn bisect(&self, mut low: f64, mut high: f64, gain: f64, imaginary: bool) -> f64 {
        let below = self.is_low(low, gain, imaginary);
        // of a step of a few percent, to 1e-9 of it
        each!(halving, 0..28, {
            let middle = 0.5 * (low + high);
            if self.is_low(middle, gain, imaginary) == below {
                low = middle;
            } else {
                high = middle;
            }
        });
        0.5 * (low + high)
    }

    const fn is_low(&self, frequency: f64, gain: f64, imaginary: bool) -> bool {
        let response = scaled(gain, self.response(frequency));
        if imaginary { response.1 < 0.0 } else { is_small(response) }
    }
}

/// Whether a response lies within the unit circle.
const fn is_small(response: Complex) -> bool {
    response.0 * response.0 + response.1 * response.1 < 1.0
}
