//! Stability margins of the sampled speed loop, by a sweep of its frequency response.

use super::ExactStep;
use crate::machine::TwoMass;
use crate::math::{atan2, exp, hypot, ln, sin_cos};

/// How far a loop is from instability.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Margins {
    /// Factor by which the gain may grow; infinite where no growth destabilises.
    pub gain_up: f64,
    /// Factor by which the gain may shrink, below 1; 0 where no loss destabilises.
    pub gain_down: f64,
    /// Smallest phase margin over all crossings of gain 1 \[rad\].
    pub phase: f64,
    /// Highest frequency at which the gain crosses 1 \[rad/s\].
    pub crossover: f64,
    /// Smallest distance of the response from -1; over 0.5 is sound.
    pub modulus: f64,
}

/// The loop cut at the torque, which acts one tick after its sample.
pub(super) struct Loop {
    pub step: ExactStep,
    pub machine: TwoMass,
    pub period: f64,
    pub proportional: f64,
    pub integral: f64,
    pub damping: f64,
    pub late: Late,
}

/// What acts later than the tick, in continuous time.
pub(super) struct Late {
    /// Dead time and lag of the actuator.
    pub delay: f64,
    pub lag: f64,
    /// Share of the load torque that is fed forward, share of the inertia that is given against the acceleration, and the lag of the
    /// estimated load torque.
    pub share: f64,
    pub inertia: f64,
    pub estimate: f64,
}

impl Late {
    /// Nothing is late.
    pub(super) const NONE: Self = Late { delay: 0.0, lag: 0.0, share: 0.0, inertia: 0.0, estimate: 0.0 };

    const fn is_none(&self) -> bool {
        self.delay == 0.0 && self.lag == 0.0 && self.share == 0.0 && self.inertia == 0.0
    }
}

type Complex = (f64, f64);

const fn times(a: Complex, b: Complex) -> Complex {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}
const fn over(a: Complex, b: Complex) -> Complex {
    let square = b.0 * b.0 + b.1 * b.1;
    ((a.0 * b.0 + a.1 * b.1) / square, (a.1 * b.0 - a.0 * b.1) / square)
}

impl Loop {
    /// Response at a frequency \[rad/s\], positive where the feedback opposes.
    const fn response(&self, frequency: f64) -> Complex {
        let angle = frequency * self.period;
        let (half, _) = sin_cos(0.5 * angle);
        let (sine, cosine) = sin_cos(angle);
        let z = (cosine, sine);
        // z - 1 without cancellation.
        let d = (-2.0 * half * half, sine);
        let n = &self.step;
        let (a, b) = ((d.0 - n.n11, d.1), (d.0 - n.n22, d.1));
        let determinant = times(a, b);
        let determinant = (determinant.0 - n.n12 * n.n21, determinant.1);
        let numerator = (n.n21 * n.g1 + a.0 * n.g2, a.1 * n.g2);
        let twist_rate = over(numerator, determinant);
        let twist_rate = (twist_rate.0 / self.machine.motor_inertia, twist_rate.1 / self.machine.motor_inertia);
        let total = self.machine.total_inertia();
        let mean = over((self.period / total, 0.0), d);
        let load = self.machine.load_inertia / total;
        let motor = (mean.0 + load * twist_rate.0, mean.1 + load * twist_rate.1);
        let integral = over(z, d);
        let controller =
            (self.proportional + self.integral * self.period * integral.0, self.integral * self.period * integral.1);
        let speed = times(controller, motor);
        let prompt = over((speed.0 + self.damping * twist_rate.0, speed.1 + self.damping * twist_rate.1), z);
        if self.late.is_none() { prompt } else { self.with_late(prompt, z, frequency) }
    }

    /// The response with what is late: `A (L + (g + s) F)/(1 - g F A + s (1 - F) A)`.
    const fn with_late(&self, prompt: Complex, z: Complex, frequency: f64) -> Complex {
        let Late { delay, lag, share, inertia, estimate } = self.late;
        let (sine, cosine) = sin_cos(frequency * delay);
        let actuator = over((cosine, -sine), (1.0, frequency * lag));
        let taken = share + inertia;
        let filter = over(over((taken, 0.0), (1.0, frequency * estimate)), z);
        // What acts on the told torque: (g + s) F - s/z.
        let own = over((inertia, 0.0), z);
        let fed = times((filter.0 - own.0, filter.1 - own.1), actuator);
        over(times(actuator, (prompt.0 + filter.0, prompt.1 + filter.1)), (1.0 - fed.0, -fed.1))
    }

    /// Whether the closed loop of a proportional and integral controller on a free mass is stable, by Nyquist's criterion: two poles at the
    /// origin, none to its right, so the response turns about -1 by half a turn from zero frequency to the Nyquist frequency; by three quarters
    /// where the whole load torque is fed forward.
    pub(super) const fn is_stable(&self, bandwidth: f64) -> bool {
        let nyquist = core::f64::consts::PI / self.period;
        let (ws, wr) = (self.machine.antiresonance(), self.machine.resonance());
        // Finer about the resonance, where a hardly damped shaft turns the response quickly.
        let edges = [1e-3 * bandwidth, 0.8 * ws, 0.99 * wr, 1.01 * wr, 1.25 * wr, nyquist];
        let mut turned = 0.0;
        let mut low = edges[0];
        let first = self.response(low);
        let mut before = (1.0 + first.0, first.1);
        let mut edge = 1;
        while edge < 6 {
            let high = if edges[edge] < nyquist { edges[edge] } else { nyquist };
            if high > low {
                let factor = exp(ln(high / low) / 80.0);
                let mut point = 0;
                while point < 80 {
                    low = if point == 79 { high } else { low * factor };
                    let response = self.response(low);
                    let after = (1.0 + response.0, response.1);
                    let turn = over(after, before);
                    turned += atan2(turn.1, turn.0);
                    before = after;
                    point += 1;
                }
            }
            edge += 1;
        }
        // Every unstable pole turns it back by half a turn.
        turned > 0.75 * core::f64::consts::PI
    }

    /// The margins, from a sweep of the whole range and a finer one about the resonance.
    pub(super) const fn margins(&self, bandwidth: f64) -> Margins {
        let nyquist = core::f64::consts::PI / self.period;
        let mut found = Margins {
            gain_up: f64::INFINITY,
            gain_down: 0.0,
            phase: f64::INFINITY,
            crossover: 0.0,
            modulus: f64::INFINITY,
        };
        self.sweep(&mut found, 1e-2 * bandwidth, nyquist, 300);
        let (from, to) = (0.8 * self.machine.antiresonance(), 1.25 * self.machine.resonance());
        if to < nyquist {
            self.sweep(&mut found, from, to, 300);
        }
        found
    }

    const fn sweep(&self, found: &mut Margins, from: f64, to: f64, points: u32) {
        let factor = exp(ln(to / from) / points as f64);
        let mut low = from;
        let mut before = self.response(low);
        let mut point = 0;
        while point < points {
            let high = if point + 1 == points { to } else { low * factor };
            let after = self.response(high);
            let distance = hypot(1.0 + after.0, after.1);
            if distance < found.modulus {
                found.modulus = distance;
            }
            if (before.1 < 0.0) != (after.1 < 0.0) {
                let crossing = self.response(self.bisect(low, high, true));
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
            if (hypot(before.0, before.1) < 1.0) != (hypot(after.0, after.1) < 1.0) {
                let frequency = self.bisect(low, high, false);
                let crossing = self.response(frequency);
                let phase = atan2(-crossing.1, -crossing.0).abs();
                if phase < found.phase {
                    found.phase = phase;
                }
                if frequency > found.crossover {
                    found.crossover = frequency;
                }
            }
            low = high;
            before = after;
            point += 1;
        }
    }

    /// Frequency between two at which the imaginary part changes sign, or the gain passes 1.
    const fn bisect(&self, mut low: f64, mut high: f64, imaginary: bool) -> f64 {
        let below = self.is_low(low, imaginary);
        let mut halving = 0;
        while halving < 40 {
            let middle = 0.5 * (low + high);
            if self.is_low(middle, imaginary) == below {
                low = middle;
            } else {
                high = middle;
            }
            halving += 1;
        }
        0.5 * (low + high)
    }

    const fn is_low(&self, frequency: f64, imaginary: bool) -> bool {
        let response = self.response(frequency);
        if imaginary { response.1 < 0.0 } else { hypot(response.0, response.1) < 1.0 }
    }
}
