//! A Kalman filter with a live covariance.

use super::model::{Model, Square, State, Unwrapped};
use crate::backlash::case::Case;
use crate::backlash::score::Estimator;

/// A Kalman filter whose covariance follows the regime.
#[derive(Clone, Copy, Debug)]
pub struct Live {
    model: Model,
    /// Over how many standard deviations of the twist the law is averaged; 0 for the law of the most probable regime.
    spread: f64,
    covariance: Square,
    angle: Unwrapped,
    state: State,
}

impl Live {
    /// For a case, at rest.
    pub fn new(case: &Case, spread: f64) -> Self {
        let covariance = Square::from(case.design().contact.posterior.0).transpose();
        Live { model: Model::new(case), spread, covariance, angle: Unwrapped::default(), state: State::zeros() }
    }

    /// Probability of contact at a twist.
    fn contact(&self, twist: f64) -> f64 {
        let half = self.model.half_gap;
        let deviation = self.spread * self.covariance[(2, 2)].sqrt();
        if deviation > 0.0 {
            below((twist - half) / deviation) + below((-half - twist) / deviation)
        } else if twist.abs() > half {
            1.0
        } else {
            0.0
        }
    }
}

/// The normal distribution's share below this, to 0.01 (the logistic curve that is nearest to it).
pub(super) fn below(deviations: f64) -> f64 {
    1.0 / (1.0 + (-1.702 * deviations).exp())
}

/// Covariance of a prediction.
pub(super) fn predicted(model: &Model, transition: &Square, input: &State, covariance: &Square) -> Square {
    let mut next = transition * covariance * transition.transpose() + input * input.transpose() * model.noise[0];
    next[(4, 4)] += model.noise[1];
    next
}

/// State and covariance corrected by an innovation, and the innovation's variance.
pub(super) fn corrected(model: &Model, state: &State, covariance: &Square, innovation: f64) -> (State, Square, f64) {
    let variance = covariance[(0, 0)] + model.measurement();
    let gain: State = covariance.column(0) / variance;
    let less = covariance - gain * covariance.row(0);
    (state + gain * innovation, (less + less.transpose()) * 0.5, variance)
}

impl Estimator for Live {
    fn tick(&mut self, angle: u32, torque: f64) {
        let measured = self.angle.take(angle);
        let state = self.model.step(&self.state, torque);
        let share = self.contact(0.5 * (self.state[2] + state[2]));
        let (contact, free) = (&self.model.contact, &self.model.free);
        let transition = contact.0 * share + free.0 * (1.0 - share);
        let input = contact.1 * share + free.1 * (1.0 - share);
        let covariance = predicted(&self.model, &transition, &input, &self.covariance);
        (self.state, self.covariance, _) = corrected(&self.model, &state, &covariance, measured - state[0]);
    }

    fn estimate(&self) -> [f64; 2] {
        self.model.estimate(&self.state)
    }
}
