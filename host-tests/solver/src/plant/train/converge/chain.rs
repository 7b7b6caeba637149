//! A run with everything that was done to it.

use super::super::plant::Plant;
use super::{NotProven, Proof, Run, Step, check};

/// A plant whose run is written down as it goes: held torques, ticks, changes of load, brake and shaft, and the result
/// of every tick.
#[derive(Debug, Clone)]
pub struct Recording {
    run: Run,
    plant: Plant,
}

impl Recording {
    /// Begins with the plant as it is.
    #[must_use]
    pub fn new(plant: Plant) -> Self {
        Self { run: Run::of(&plant.motion), plant }
    }

    /// [`Plant::advance`], written down.
    pub fn advance(&mut self, motor_torque: f64, dt: f64) {
        if self.is_done(|plant| plant.advance(motor_torque, dt)) {
            self.run.note(Step::Torque(0, self.plant.motion.held[0]), &self.plant.motion);
            self.run.note(Step::Advance(dt), &self.plant.motion);
        }
    }

    /// [`Plant::set_load_torque`], written down.
    pub fn set_load_torque(&mut self, node: usize, torque: f64) {
        if self.is_done(|plant| plant.set_load_torque(node, torque)) {
            self.run.note(Step::Torque(node, self.plant.motion.held[node]), &self.plant.motion);
        }
    }

    /// [`Plant::set_brake`], written down.
    pub fn set_brake(&mut self, node: usize, torque: f64) {
        if self.is_done(|plant| plant.set_brake(node, torque)) {
            self.run.note(Step::Friction(node, self.plant.coulomb[node] + torque), &self.plant.motion);
        }
    }

    /// [`Plant::set_shaft`], written down.
    pub fn set_shaft(&mut self, shaft: usize, stiffness: f64, damping: f64) {
        if self.is_done(|plant| plant.set_shaft(shaft, stiffness, damping)) {
            self.run.note(Step::Link(shaft, stiffness, damping), &self.plant.motion);
        }
    }

    fn is_done(&mut self, step: impl FnOnce(&mut Plant)) -> bool {
        let refused = self.plant.refused();
        step(&mut self.plant);
        self.plant.refused() == refused
    }

    /// The plant as it stands.
    #[must_use]
    pub fn plant(&self) -> &Plant {
        &self.plant
    }
}

/// Runs both checks.
///
/// # Errors
/// [`NotProven`] if one of them comes out more than [`BOUND`](super::BOUND) from the recording, or cannot be done.
pub fn prove(run: &Recording) -> Result<Proof, NotProven> {
    check(&run.run, false, |_| {})
}
