//! The loop of a governor with a late actuator, by its frequency response: dead times of any length, and estimates with
//! a lag.

use super::ExactStep;
use super::complex::{Complex, over, times};
use crate::machine::TwoMass;
use crate::math::{atan2, exp, ln, sin_cos};

/// The loop cut at the torque, which acts one tick after its sample.
#[derive(Clone, Copy)]
pub(super) struct LateLoop {
    pub step: ExactStep,
    pub machine: TwoMass,
    pub period: f64,
    pub proportional: f64,
    pub integral: f64,
    pub late: Late,
}

/// Delays beyond the tick, in continuous time.
#[derive(Clone, Copy)]
pub(super) struct Late {
    /// Dead time and lag of the actuator.
    pub delay: f64,
    pub lag: f64,
    /// Share of the load torque that is fed forward, share of the inertia that is given against the acceleration, and
    /// the lag of the estimated load torque.
    pub share: f64,
    pub inertia: f64,
    pub estimate: f64,
}

impl LateLoop {
    /// Response at a frequency (rad/s), positive where the feedback opposes.
    pub(super) const fn response(&self, frequency: f64) -> Complex {
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
        let slip = over(numerator, determinant);
        let slip = (slip.0 / self.machine.motor_inertia, slip.1 / self.machine.motor_inertia);
        let total = self.machine.total_inertia();
        let mean = over((self.period / total, 0.0), d);
        let load = self.machine.load_inertia / total;
        let motor = (mean.0 + load * slip.0, mean.1 + load * slip.1);
        let integral = over(z, d);
        let controller =
            (self.proportional + self.integral * self.period * integral.0, self.integral * self.period * integral.1);
        let speed = times(controller, motor);
        self.with_late(over(speed, z), z, frequency)
    }

    /// The response with delays: `A (L + (g + s) F)/(1 - g F A + s (1 - F) A)`.
    const fn with_late(&self, prompt: Complex, z: Complex, frequency: f64) -> Complex {
        let Late { delay, lag, share, inertia, estimate } = self.late;
        let (sine, cosine) = sin_cos(frequency * delay);
        let actuator = over((cosine, -sine), (1.0, frequency * lag));
        let taken = share + inertia;
        let filter = over(over((taken, 0.0), (1.0, frequency * estimate)), z);
        // Acts on the reported torque: (g + s) F - s/z.
        let own = over((inertia, 0.0), z);
        let fed = times((filter.0 - own.0, filter.1 - own.1), actuator);
        over(times(actuator, (prompt.0 + filter.0, prompt.1 + filter.1)), (1.0 - fed.0, -fed.1))
    }

    /// Whether the closed loop of a proportional and integral controller on a free mass is stable, by Nyquist's
    /// criterion: two poles at the origin, none to its right, so the response turns about -1 by half a turn from zero
    /// frequency to the Nyquist frequency; by three quarters where the whole load torque is fed forward.
    pub(super) const fn is_stable(&self, bandwidth: f64) -> bool {
        let nyquist = core::f64::consts::PI / self.period;
        let (ws, wr) = (self.machine.antiresonance(), self.machine.resonance());
        // Finer about the resonance, where a lightly damped shaft turns the response quickly.
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
}
