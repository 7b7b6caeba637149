//! The requirement.

use serde::Serialize;

use driveline_closed_loop::lockstep::Trace;
use driveline_closed_loop::scenario::Machine;
use driveline_report::Variant;

/// Root mean square errors that are allowed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Aim {
    /// Of the shaft torque, over its peak.
    pub shaft_torque: f64,
    /// Of the load's speed, over rated; none through backlash.
    pub load_speed: Option<f64>,
}

impl Aim {
    /// With a tight shaft.
    pub const TIGHT: Self = Self {
        shaft_torque: driveline::design::Requirement::USUAL.shaft_torque,
        load_speed: Some(driveline::design::Requirement::USUAL.load_speed),
    };

    /// Through backlash.
    pub const BACKLASH: Self = Self { shaft_torque: 0.06, load_speed: None };

    /// Of a machine in its runs: through backlash where a plant has some, and it opens.
    pub fn of(machine: &Machine, traces: &[Trace]) -> Self {
        let mut runs = machine.scenarios.iter().zip(traces);
        let through = runs
            .any(|(scenario, trace)| scenario.plant.has_backlash() && trace.moments.iter().any(|moment| moment.open));
        if through { Self::BACKLASH } else { Self::TIGHT }
    }

    /// By how much a variant's shaft torque is over it; negative where it is kept, and not finite where it diverged.
    pub fn torque_missed(&self, variant: &Variant) -> f64 {
        variant.shaft_torque.rms - self.shaft_torque
    }

    /// The same of the load's speed; none where there is no aim.
    pub fn speed_missed(&self, variant: &Variant) -> Option<f64> {
        self.load_speed.map(|aim| variant.load_speed.rms - aim)
    }

    /// Whether a variant keeps both. A value that is not a number fails.
    pub fn kept(&self, variant: &Variant) -> bool {
        self.torque_missed(variant) <= 0.0 && self.speed_missed(variant).is_none_or(|missed| missed <= 0.0)
    }
}
