//! The drives of a comparison of rates on drawn machines, in closed loop with the full solver.

use driveline::design::ObserverChoice;
use driveline_report::format::rate;

use super::rates::Choice;
use crate::campaign::drive::Drive;
use crate::campaign::scenes::CampaignScene;
use crate::campaign::tune::of_share;
use crate::campaign::{Figure, outcomes};
use crate::cli::Progress;
use crate::machine_file::MachineFile;

/// Runs each choice that has all margins with so many machines.
pub fn fill(choices: &mut [Choice], machine: &MachineFile, draws: u64) {
    if draws == 0 {
        return;
    }
    let progress = Progress::of(choices.iter().filter(|choice| choice.lacks.is_none()).count() as u64);
    for choice in choices.iter_mut().filter(|choice| choice.lacks.is_none()) {
        progress.says(&format!("{} at {}", choice.observer, rate(choice.rate_hz)));
        match drawn(&machine.with_rate(choice.rate_hz), choice.observer, draws) {
            Ok(found) => choice.drawn = Some(found),
            Err(why) => choice.lacks = Some(why),
        }
        progress.step();
    }
}

/// Median errors of shaft torque, load speed and load torque over drawn machines.
fn drawn(machine: &MachineFile, observer: &str, draws: u64) -> Result<[f64; 3], String> {
    let scene = CampaignScene::of_file(machine.clone())?;
    let observer = match observer {
        "rigid" => ObserverChoice::Rigid,
        "semi-implicit" => ObserverChoice::SemiImplicit,
        _ => ObserverChoice::Exact,
    };
    let drive = Drive::File(observer, machine.control.rate_hz);
    let outcomes = outcomes(&scene, &drive, &scene.tolerances(), (1, draws), None)?;
    match outcomes.iter().filter(|outcome| outcome.is_unstable()).count() {
        0 => Ok([Figure::ShaftTorque, Figure::LoadSpeed, Figure::LoadTorque].map(|f| of_share(f, &outcomes, 0.5))),
        unstable => Err(format!("{unstable} of {draws} drawn machines are unstable")),
    }
}
