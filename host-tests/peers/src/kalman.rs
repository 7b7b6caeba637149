//! A Kalman filter whose covariance is computed in every tick.
//!
//! The angle is counted from the last measured one: the turn of a tick is taken off the predicted state, and the
//! measurement is zero. So it loses no resolution in `f32` over many turns.

use crate::model::{Model, Peer, at_rest, estimate};

/// `idsp::kalman`, its transition dense, its observation direct.
#[derive(Clone, Copy, Debug)]
pub struct Idsp {
    transition: idsp::kalman::Transition<f32, 5>,
    observation: idsp::kalman::Direct<f32, 0>,
    input: [f32; 5],
    shaft: [f32; 2],
    estimate: idsp::kalman::Estimate<f32, 5>,
}

impl Idsp {
    /// With the library's noises.
    pub fn new(model: &Model) -> Self {
        Idsp {
            transition: idsp::kalman::Transition::new(model.transition, model.noise),
            observation: idsp::kalman::Direct::new(model.measurement),
            input: model.input,
            shaft: model.shaft,
            estimate: idsp::kalman::Estimate::new([0.0; 5], model.covariance),
        }
    }
}

impl Peer for Idsp {
    fn start(&mut self, torque: f32) {
        self.estimate.state = at_rest(self.shaft, torque);
    }

    #[inline(always)]
    fn step(&mut self, turn: f32, torque: f32, deadband: f32) {
        self.transition.predict(&mut self.estimate);
        for (state, input) in self.estimate.state.iter_mut().zip(self.input) {
            *state += input * torque;
        }
        self.estimate.state[0] -= turn;
        if !(self.estimate.state[0].abs() <= deadband) {
            self.observation.correct(&mut self.estimate, 0.0);
        }
    }

    #[inline(always)]
    fn estimate(&self) -> [f32; 3] {
        let state = &self.estimate.state;
        estimate(self.shaft, state[1], state[2], state[3])
    }
}
