//! Estimates against the recording: rms innovation, errors, flags.

use std::fmt::Write;

use driveline::fault::Faults;
use driveline_report::Table;
use driveline_report::format::{counted, percent, significant};
use serde::Serialize;

use super::run::{Course, Replayed};

/// What a run of a number came to.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// `f32` or `fixed`.
    pub number: &'static str,
    /// Rms innovation (rad).
    pub innovation: f64,
    /// The same over that which the design predicts.
    pub innovation_ratio: f64,
    /// Rms error of each measured quantity, of the rms of the quantity itself; `null` where it was not measured.
    pub load_speed_error: Option<f64>,
    /// The same of the shaft torque.
    pub shaft_torque_error: Option<f64>,
    /// The same of the load torque.
    pub load_torque_error: Option<f64>,
    /// Ticks with each fault.
    pub faults: Vec<(&'static str, usize)>,
}

/// The summary of each number.
pub fn summaries(replayed: &Replayed) -> Vec<Summary> {
    replayed.courses.iter().map(|course| summary(replayed, course)).collect()
}

fn summary(replayed: &Replayed, course: &Course) -> Summary {
    let skip = replayed.settling;
    let signals = &replayed.signals;
    let error = |estimate: &[f64], truth: &Option<Vec<f64>>, floating: bool| {
        let truth = truth.as_ref()?.get(skip..)?;
        let estimate = estimate.get(skip..)?;
        let errors: Vec<f64> = estimate.iter().zip(truth).map(|(estimate, truth)| estimate - truth).collect();
        let size = rms(truth, true);
        (size > 0.0).then(|| rms(&errors, floating) / size)
    };
    let innovation = course.innovation.get(skip..).unwrap_or_default();
    let innovation: Vec<f64> = innovation.iter().copied().filter(|innovation| innovation.is_finite()).collect();
    let innovation = rms(&innovation, false);
    // of the whole recording: a flag of the first ticks is one, too
    let ticks = |fault: Faults| course.faults.iter().filter(|faults| faults.contains(fault)).count();
    let faults = Faults::NAMES.iter().map(|(fault, name)| (*name, ticks(*fault))).filter(|(_, count)| *count > 0);
    Summary {
        number: course.number,
        innovation,
        innovation_ratio: innovation / replayed.predicted,
        load_speed_error: error(&course.load_speed, &signals.load_speed, false),
        shaft_torque_error: error(&course.shaft_torque, &signals.shaft_torque, signals.floating),
        load_torque_error: error(&course.load_torque, &signals.load_torque, false),
        faults: faults.collect(),
    }
}

/// Root mean square, about the mean where that is not known.
fn rms(values: &[f64], about_mean: bool) -> f64 {
    let count = values.len().max(1) as f64;
    let mean = if about_mean { values.iter().sum::<f64>() / count } else { 0.0 };
    (values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / count).sqrt()
}

/// The summaries as a table.
pub fn table(replayed: &Replayed) -> Table {
    let mut table = Table::new([
        "number",
        "innovation rad rms",
        "over predicted",
        "load speed error",
        "shaft torque error",
        "load torque error",
        "flags",
    ]);
    for summary in summaries(replayed) {
        let share = |error: Option<f64>| error.map_or_else(|| "not measured".to_owned(), percent);
        let flags: Vec<String> = summary
            .faults
            .iter()
            .map(|(name, count)| format!("{name} in {}", counted(*count as u64, "tick")))
            .collect();
        table.row([
            summary.number.to_owned(),
            significant(summary.innovation),
            significant(summary.innovation_ratio),
            share(summary.load_speed_error),
            share(summary.shaft_torque_error),
            share(summary.load_torque_error),
            if flags.is_empty() { "none".to_owned() } else { flags.join(", ") },
        ]);
    }
    table
}

/// Every tick as a line of CSV.
pub fn csv(replayed: &Replayed) -> String {
    let mut text = String::from("time_s");
    for course in &replayed.courses {
        for name in ["motor_speed_rad_s", "load_speed_rad_s", "shaft_torque_Nm", "load_torque_Nm", "innovation_rad"] {
            // writing to a string cannot fail
            let _ = write!(text, ",{}_{name}", course.number);
        }
        let _ = write!(text, ",{}_faults", course.number);
    }
    text.push('\n');
    for (tick, time) in replayed.signals.time.iter().enumerate() {
        let _ = write!(text, "{time:.6}");
        for course in &replayed.courses {
            let columns = [
                &course.motor_speed,
                &course.load_speed,
                &course.shaft_torque,
                &course.load_torque,
                &course.innovation,
            ];
            for column in columns {
                let _ = write!(text, ",{:.6e}", column[tick]);
            }
            let _ = write!(text, ",{}", course.faults[tick].bits());
        }
        text.push('\n');
    }
    text
}
