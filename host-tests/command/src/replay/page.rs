//! The page of a replay: estimates over measurements.

use driveline_report::chart::Line;
use driveline_report::{Fact, Figure, Section, Sheet};

use super::run::Replayed;
use super::table::table;

/// Points of a curve at most; a longer recording is shown from its end of settling on.
const SHOWN: usize = 20_000;

/// The page as HTML.
pub fn page(name: &str, machine: &str, facts: Vec<Fact>, replayed: &Replayed) -> String {
    let signals = &replayed.signals;
    let from = if signals.time.len() > SHOWN { replayed.settling } else { 0 };
    let shown = from..signals.time.len().min(from + SHOWN);
    let cut = |values: &[f64]| values[shown.clone()].to_vec();
    let Some(course) = replayed.courses.first() else { return String::new() };
    let figure = |title: &str, axis: &str, estimate: &[f64], measured: Option<&Vec<f64>>| {
        let mut lines = Vec::new();
        if let Some(measured) = measured {
            lines.push(Line { name: "measured".to_owned(), class: "truth".to_owned(), values: cut(measured) });
        }
        lines.push(Line { name: "estimated".to_owned(), class: "s0".to_owned(), values: cut(estimate) });
        Figure::over_time(title, String::new(), &cut(&signals.time), &lines, axis, &[])
    };
    // a twist whose zero is not known is drawn about the estimate's mean
    let mean = |values: &[f64]| values[shown.clone()].iter().sum::<f64>() / shown.len().max(1) as f64;
    let torque: Option<Vec<f64>> = signals.shaft_torque.as_ref().map(|torque| {
        let shift = if signals.floating { mean(&course.shaft_torque) - mean(torque) } else { 0.0 };
        torque.iter().map(|value| value + shift).collect()
    });
    let mut shaft = figure("Shaft torque", "shaft torque, N m", &course.shaft_torque, torque.as_ref());
    if signals.floating {
        shaft.text =
            "Measured by the twist of two encoders, whose zeros are not known: both about one mean.".to_owned();
    }
    let faulty = |index: usize| !course.faults[index].is_none();
    let marks: Vec<f64> = shown.clone().filter(|index| faulty(*index)).map(|index| signals.time[index]).collect();
    let mut innovation = figure("Innovation", "innovation, rad", &course.innovation, None);
    innovation.text = format!("Measured less predicted angle; {} of the ticks shown raise a flag.", marks.len());
    Sheet {
        name: name.to_owned(),
        kicker: "Replay".to_owned(),
        summary: format!(
            "The observer of {machine} over the recording, in single precision; fixed point in the table."
        ),
        facts,
        figures: vec![
            figure("Motor speed", "motor speed, rad/s", &course.motor_speed, signals.motor_speed.as_ref()),
            figure("Load speed", "load speed, rad/s", &course.load_speed, signals.load_speed.as_ref()),
            shaft,
            figure("Load torque", "load torque, N m", &course.load_torque, signals.load_torque.as_ref()),
            innovation,
        ],
        tables: vec![Section::new(
            "Errors and flags",
            "Rms errors of the rms of the measured quantity, after the observer has settled.",
            table(replayed),
        )],
    }
    .page()
}
