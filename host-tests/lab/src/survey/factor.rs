//! Dynamic factors: how much more than a rigid machine's the shaft carries.

use serde::Serialize;

use driveline_closed_loop::lockstep::Moment;
use driveline_closed_loop::scenario::{Machine, Scenario};

/// The shaft torque's peak in a run, and what it would be were nothing to swing.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Factor {
    /// The run.
    pub scenario: String,
    /// Whether a gap was open or a rope slack in it.
    pub opened: bool,
    /// Peak of the true shaft torque (N m).
    pub peak: f64,
    /// Peak of what the shaft would carry between rigid inertias under the same torques (N m).
    pub rigid: f64,
}

impl Factor {
    /// K, the peak over the rigid machine's [derived; headings: Huang 1987 ch. 3 to 7]; none where that carries
    /// nothing, or is not known for a crank.
    pub fn k(&self) -> Option<f64> {
        (self.rigid > 0.0).then(|| self.peak / self.rigid)
    }

    /// Of a run. The rigid machine gains speed as the whole one gains momentum: `tau_L + J_L p'/J`, with the momentum
    /// p about the motor's shaft, in which motor, brakes, loads and losses are all contained.
    pub fn of(machine: &Machine, scenario: &Scenario, moments: &[Moment]) -> Self {
        let plant = &scenario.plant;
        let total: f64 = (0..plant.nodes()).map(|node| plant.inertia(node)).sum();
        let share = plant.inertia(machine.load) / total;
        let rigid = moments.windows(2).map(|pair| {
            let rate = (pair[1].momentum - pair[0].momentum) / (pair[1].time - pair[0].time);
            (pair[0].truth[2] + share * rate).abs()
        });
        let peak = moments.iter().map(|moment| moment.truth[0].abs());
        Self {
            scenario: scenario.name.to_owned(),
            opened: moments.iter().any(|moment| moment.open),
            peak: peak.fold(0.0, f64::max),
            rigid: rigid.fold(0.0, f64::max),
        }
    }
}
