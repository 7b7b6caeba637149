//! The drives of a comparison of rates on drawn machines, in closed loop with the full solver.

use driveline_closed_loop::departure::Departure;
use driveline_report::format::rate;

use super::rates::Choice;
use crate::campaign::drive::Drive;
use crate::campaign::run::run;
use crate::campaign::scenes::CampaignScene;
use crate::campaign::{Draw, Figure, quantile, work};
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
    let nominal = scene.departing(&Departure::NONE).map_err(|error| error.to_string())?;
    let drive = Drive::named(&scene, &nominal, Some(if observer == "exact" { "two-mass" } else { observer }))?;
    let (tolerances, numbers) = (scene.tolerances(), (0..draws).collect::<Vec<_>>());
    let mut outcomes = Vec::new();
    work(&numbers, None, &|number| run(&scene, &drive, &Draw::new(&tolerances, 1, number)), &mut |_, outcome| {
        outcomes.push(outcome);
        Ok(())
    })?;
    match outcomes.iter().filter(|outcome| outcome.is_unstable()).count() {
        0 => Ok([Figure::ShaftTorque, Figure::LoadSpeed, Figure::LoadTorque].map(|figure| {
            let mut errors: Vec<f64> = outcomes.iter().filter_map(|outcome| outcome.found(figure)).collect();
            errors.sort_by(f64::total_cmp);
            quantile(&errors, 0.5)
        })),
        unstable => Err(format!("{unstable} of {draws} drawn machines are unstable")),
    }
}
