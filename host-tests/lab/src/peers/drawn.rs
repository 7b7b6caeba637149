//! Runs of machines out of a scene's tolerances, which no observer here was tuned on.

use std::error::Error;
use std::ops::Range;

use super::recording::Recording;
use crate::campaign::SCENES as CAMPAIGNS;
use crate::drivetrains::Build;
use cargo_driveline::campaign::Draw;
use cargo_driveline::machine_file::class::Class;
use driveline_closed_loop::departure::Departure;
use driveline_closed_loop::scenario::Machine;
use driveline_solver::plant::PlantError;

/// Seed of the draws.
const SEED: u64 = 1;
/// The torque's noise in every scene, of rated torque.
const NOISE: f64 = 0.01;

impl Recording {
    /// One run each of machines drawn from the tolerances of a scene's campaign. Where it has none, motor, inverter and
    /// encoder are drawn as of any drive. The noise is another one in each.
    pub fn drawn(scene: &str, build: Build, numbers: Range<u64>, seconds: f64) -> Result<Self, Box<dyn Error>> {
        let campaign = CAMPAIGNS.iter().find(|campaign| campaign.name == scene);
        let tolerances = campaign.map_or_else(|| Class::General.drive(), |campaign| campaign.tolerances());
        let departing = |by: &Departure| -> Result<Machine, PlantError> {
            campaign.map_or_else(build, |campaign| campaign.departing(by))
        };
        let mut all = Recording { ticks: Vec::new(), references: [0.0; 2] };
        for number in numbers {
            let draw = Draw::new(&tolerances, SEED, number);
            let machine = departing(&draw.departure())?;
            let lines = campaign.map_or(machine.encoder.lines(), |campaign| campaign.lines);
            let mut imperfections = draw.imperfections(lines, machine.torque_noise / NOISE);
            if let Some(campaign) = campaign {
                imperfections.actuator.delay += campaign.actuator.delay * f64::from(machine.chosen.1);
                imperfections.actuator.lag += campaign.actuator.lag;
            }
            let run = Recording::of(&machine, seconds, &imperfections)?;
            all.ticks.extend(run.ticks);
            all.references = [0, 1].map(|k| run.references[k].max(all.references[k]));
        }
        Ok(all)
    }
}
