//! Three hypotheses, left, free and right, mixed and weighed in every tick [Blom and Bar-Shalom 1988, IEEE Trans.
//! Autom. Control 33(8)].

use super::live::{below, corrected, predicted};
use super::model::{Model, Square, State, Unwrapped};
use crate::backlash::case::Case;
use crate::backlash::score::Estimator;

/// Smallest probability of a regime.
const LEAST: f64 = 1e-6;

#[derive(Clone, Copy, Debug)]
struct Hypothesis {
    weight: f64,
    state: State,
    covariance: Square,
}

/// Three Kalman filters, one for each regime.
#[derive(Clone, Copy, Debug)]
pub struct Several {
    model: Model,
    /// Left, free, right.
    each: [Hypothesis; 3],
    angle: Unwrapped,
}

impl Several {
    /// For a case, at rest.
    pub fn new(case: &Case) -> Self {
        let covariance = Square::from(case.design().contact.posterior.0).transpose();
        let one = |weight| Hypothesis { weight, state: State::zeros(), covariance };
        Several { model: Model::new(case), each: [0.1, 0.8, 0.1].map(one), angle: Unwrapped::default() }
    }

    /// Chances of left, free and right where a hypothesis takes its twist to be.
    fn regimes(&self, hypothesis: &Hypothesis) -> [f64; 3] {
        let (twist, half) = (hypothesis.state[2], self.model.half_gap);
        let deviation = hypothesis.covariance[(2, 2)].sqrt();
        let (left, right) = (below((-half - twist) / deviation), below((twist - half) / deviation));
        [left, (1.0 - left - right).max(0.0), right]
    }
}

impl Estimator for Several {
    fn tick(&mut self, angle: u32, torque: f64) {
        let measured = self.angle.take(angle);
        let chances = self.each.map(|hypothesis| self.regimes(&hypothesis));
        let before = self.each;
        for (regime, next) in self.each.iter_mut().enumerate() {
            // Mixture of the hypotheses in this regime.
            let parts = [0, 1, 2].map(|from| before[from].weight * (chances[from][regime] + LEAST));
            let prior: f64 = parts.iter().sum();
            let mean: State = (0..3).map(|from| before[from].state * (parts[from] / prior)).sum();
            let mut covariance = Square::zeros();
            for from in 0..3 {
                let apart = before[from].state - mean;
                covariance += (before[from].covariance + apart * apart.transpose()) * (parts[from] / prior);
            }
            let flank = [-1.0, 0.0, 1.0][regime] * self.model.half_gap;
            let law = if regime == 1 { &self.model.free } else { &self.model.contact };
            let state = if regime == 1 { law.0 * mean + law.1 * torque } else { self.model.side(&mean, torque, flank) };
            let covariance = predicted(&self.model, &law.0, &law.1, &covariance);
            let innovation = measured - state[0];
            let (state, covariance, variance) = corrected(&self.model, &state, &covariance, innovation);
            let likelihood = (-0.5 * innovation * innovation / variance).exp() / variance.sqrt();
            *next = Hypothesis { weight: prior * likelihood + f64::MIN_POSITIVE, state, covariance };
        }
        let sum: f64 = self.each.iter().map(|hypothesis| hypothesis.weight).sum();
        self.each.iter_mut().for_each(|hypothesis| hypothesis.weight /= sum);
    }

    fn estimate(&self) -> [f64; 2] {
        let mut estimate = [0.0; 2];
        for (regime, hypothesis) in self.each.iter().enumerate() {
            let flank = [-1.0, 0.0, 1.0][regime] * self.model.half_gap;
            let [torque, speed] =
                if regime == 1 { [0.0, hypothesis.state[3]] } else { self.model.taut(&hypothesis.state, flank) };
            estimate[0] += hypothesis.weight * torque;
            estimate[1] += hypothesis.weight * speed;
        }
        estimate
    }
}
