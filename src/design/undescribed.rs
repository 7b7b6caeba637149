//! A resonance that a description leaves out, and whether a speed loop is stable with it.

use super::closed_loop::ClosedLoop;
use super::complex::{over, times};
use super::plant::Plant;
use crate::math::{sin_cos, sqrt};

/// One resonance that the description leaves out, anywhere above a frequency.
///
/// A shaft, a frame or a foundation that nobody described adds a vibration to what the motor feels: `r/(w_0^2 - w^2 + 2
/// j z w_0 w)` in its angle per torque. M is the loop's torque per angle that is added to the measured one, closed
/// round the described machine. The loop turns unstable where `1 + M r/(w_0^2 - w^2 + 2 j z w_0 w)` is zero at a
/// frequency w: `w_0^2 = w^2 - r Re M` and `-r Im M = 2 z w_0 w`. It starts from a stable loop at r = 0. So it is stable
/// with every such vibration if `-r Im M < 2 z w_0 w` at every w, for the largest r that leaves w_0 within its range.
///
/// Where the imaginary part of M is positive, the motor damps whatever it drives, and any weight will do; where M is
/// small, the vibration's own damping will do. This mixes passivity and small gain [Griggs, Anderson, Lanzon 2007,
/// Syst. Control Lett. 56(9-10)].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Undescribed {
    /// Frequency up to which the description holds, over the resonance of the two masses; 2 or above.
    pub above: f64,
    /// Weight: modal gain at the motor times the inertia of the motor side. A motor that has the share s of that
    /// inertia, the rest behind a shaft, has `1/s - 1`. 0 for none.
    pub weight: f64,
    /// Least damping ratio, above 0.
    pub damping_ratio: f64,
}

impl Undescribed {
    /// Above eight times the resonance, of a tenth of the motor side's inertia, 2 % damped.
    pub const USUAL: Self = Self { above: 8.0, weight: 0.1, damping_ratio: 0.02 };

    /// None.
    pub const NONE: Self = Self { weight: 0.0, ..Self::USUAL };

    /// Whether every field is in its range.
    pub(super) const fn is_sound(&self) -> bool {
        let Self { above, weight, damping_ratio } = *self;
        above >= 2.0
            && above.is_finite()
            && weight >= 0.0
            && weight.is_finite()
            && damping_ratio > 0.0
            && damping_ratio.is_finite()
    }
}

/// Ratio of two frequencies that are tested one after the other.
const STEP: f64 = 1.06;

impl ClosedLoop {
    /// Whether the loop round a machine, with its torque times each of the gains, is stable with a resonance from
    /// `least` (rad/s) on, of a modal gain up to `residue` (1/(kg m2)) and this damping ratio at least.
    ///
    /// At frequencies up to the sample rate, each 6 % above the one before: the response has no peak there that is
    /// narrower, for the described resonances lie below. At the sample rate the held torque moves nothing.
    pub(super) const fn bears(&self, plant: &Plant, gains: &[f64; 3], least: f64, residue: f64, damping: f64) -> bool {
        let (n, d) = plant.sampled(self.period);
        let (controller, open, rest) = self.parts(&n, &d);
        let rate = core::f64::consts::TAU / self.period;
        let mut frequency = 0.4 * least;
        while frequency < rate {
            let turn = 0.5 * frequency * self.period;
            let (half, cosine) = sin_cos(turn);
            // z - 1 without cancellation, and what holding the torque for a tick makes of a vibration
            let delta = (-2.0 * half * half, 2.0 * half * cosine);
            let hold = (cosine * half / turn, -half * half / turn);
            let acts = times(controller.at(delta), hold);
            let (opened, given) = (open.at(delta), rest.at(delta));
            each!(k, 0..gains.len(), {
                let gain = gains[k];
                let closed = over(acts, (given.0 + gain * opened.0, given.1 + gain * opened.1));
                let (re, im) = (gain * closed.0, gain * closed.1);
                if !is_damped(frequency, (re, im), least, residue, damping) {
                    return false;
                }
            });
            let step = frequency * (STEP - 1.0);
            frequency += if step < rate / 32.0 { step } else { rate / 32.0 };
        }
        true
    }
}

/// Whether no vibration from `least` on is undamped at a frequency, the loop answering an angle with this torque.
const fn is_damped(frequency: f64, (re, im): (f64, f64), least: f64, residue: f64, damping: f64) -> bool {
    let beyond = (frequency - least) * (frequency + least);
    let mut residue = residue;
    if re * residue > beyond {
        if beyond <= 0.0 {
            return true;
        }
        residue = beyond / re;
    }
    let own = sqrt(frequency * frequency - residue * re);
    -im * residue < 2.0 * damping * frequency * own
}
