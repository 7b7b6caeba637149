//! A run with everything that was done to it.

use super::super::solver::Plant;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Step {
    Advance { torque: f64, dt: f64 },
    Load { node: usize, torque: f64 },
    Brake { node: usize, torque: f64 },
    Shaft { shaft: usize, stiffness: f64, damping: f64 },
}

/// A plant whose run is written down as it goes: held torques, ticks, changes of load, brake and shaft, and the result
/// of every tick.
#[derive(Debug, Clone)]
pub struct Recording {
    pub(super) start: Plant,
    pub(super) steps: Vec<Step>,
    pub(super) samples: Vec<Vec<f64>>,
    /// Of the samples, s.
    pub(super) times: Vec<f64>,
    plant: Plant,
}

impl Recording {
    /// Begins with the plant as it is.
    #[must_use]
    pub fn new(plant: Plant) -> Self {
        let start = plant.clone();
        Self { start, steps: Vec::new(), samples: Vec::new(), times: Vec::new(), plant }
    }

    /// [`Plant::advance`], written down.
    pub fn advance(&mut self, motor_torque: f64, dt: f64) {
        let refused = self.plant.refused();
        self.plant.advance(motor_torque, dt);
        if self.plant.refused() == refused {
            self.steps.push(Step::Advance { torque: motor_torque, dt });
            self.samples.push(sample(&self.plant));
            self.times.push(self.plant.time());
        }
    }

    /// [`Plant::set_load_torque`], written down.
    pub fn set_load_torque(&mut self, node: usize, torque: f64) {
        let refused = self.plant.refused();
        self.plant.set_load_torque(node, torque);
        if self.plant.refused() == refused {
            self.steps.push(Step::Load { node, torque });
        }
    }

    /// [`Plant::set_brake`], written down.
    pub fn set_brake(&mut self, node: usize, torque: f64) {
        let refused = self.plant.refused();
        self.plant.set_brake(node, torque);
        if self.plant.refused() == refused {
            self.steps.push(Step::Brake { node, torque });
        }
    }

    /// [`Plant::set_shaft`], written down.
    pub fn set_shaft(&mut self, shaft: usize, stiffness: f64, damping: f64) {
        let refused = self.plant.refused();
        self.plant.set_shaft(shaft, stiffness, damping);
        if self.plant.refused() == refused {
            self.steps.push(Step::Shaft { shaft, stiffness, damping });
        }
    }

    /// The plant as it stands.
    #[must_use]
    pub fn plant(&self) -> &Plant {
        &self.plant
    }
}

/// Speeds, then shaft torques, then the motor's angle.
pub(super) fn sample(plant: &Plant) -> Vec<f64> {
    let speeds = (0..plant.nodes()).map(|j| plant.speed(j));
    let torques = (0..plant.nodes() - 1).map(|s| plant.shaft_torque(s));
    speeds.chain(torques).chain([plant.motor_angle()]).collect()
}
