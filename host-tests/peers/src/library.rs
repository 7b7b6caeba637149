//! The library's observers, each with its constants beside it.

use driveline::number::Number;
use driveline::observer::Observer;
use driveline_firmware::scene::{Input, Output};

use crate::model::Replayed;

/// An observer of the library.
#[derive(Clone, Copy, Debug)]
pub struct Driveline<N: Number, O: Observer<N>> {
    config: O::Config,
    observer: O,
}

impl<N: Number, O: Observer<N>> Driveline<N, O> {
    /// At rest at angle zero.
    pub fn new(config: O::Config) -> Self {
        Driveline { observer: O::at_rest(&config, 0, N::ZERO), config }
    }
}

impl<N: Number, O: Observer<N>> Replayed for Driveline<N, O> {
    fn start(&mut self, input: &Input) {
        self.observer = O::at_rest(&self.config, input.angle, N::from_word(input.torque));
    }

    #[inline(always)]
    fn tick(&mut self, input: &Input, output: &mut Output) {
        self.observer.step(&self.config, input.angle, N::from_word(input.torque));
        let estimate = self.observer.estimate(&self.config);
        output.shaft_torque = estimate.shaft_torque.to_word();
        output.load_speed = estimate.load_speed.to_word();
    }
}
