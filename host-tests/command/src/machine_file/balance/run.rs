//! A run: its readings and their speeds.

use driveline::balancing::{Complex, Entry, Error, Run};

use super::file::ROWS;
use super::polar::pairs;
use super::units::AngleConvention;
use super::value::list;
use crate::machine_file::{Diagnostic, Quantity, Table};

/// A run, its readings, and the speed of each (rpm).
pub(super) type Typed = (Run<f64, ROWS>, Vec<Complex<f64>>, Vec<f64>);

/// What all runs of a file have in common.
pub(super) struct Common {
    pub(super) rows: usize,
    pub(super) convention: AngleConvention,
    pub(super) run_out: Vec<Complex<f64>>,
    /// Speeds of the baseline (rpm), empty without any; none before it is read.
    pub(super) baseline: Option<Vec<f64>>,
}

/// Readings and their speeds: those of the baseline where none is given.
pub(super) fn run(table: &mut Table<'_>, common: &Common, entry: &mut Entry) -> Result<Typed, Diagnostic> {
    let rows = common.rows;
    let mut readings = pairs(table, "readings", rows, entry, common.convention, AngleConvention::reading)?;
    for (reading, run_out) in readings.iter_mut().zip(&common.run_out) {
        *reading -= run_out;
    }
    if !table.has("rpm") {
        let rpm = common.baseline.clone().unwrap_or_default();
        // any speed will do where all runs are of the same
        let speeds = if rpm.is_empty() { vec![1.0; rows] } else { radians_per_second(&rpm) };
        let run = Run::new(&readings, &speeds).map_err(|refusal| refused(table, refusal))?;
        return Ok((run, readings, rpm));
    }
    if common.baseline.as_ref().is_some_and(Vec::is_empty) {
        return Err(table.wrong("rpm", "no speed, as the baseline has none: give it to both, or to none"));
    }
    // one speed for all, or one for each
    let rpm = match table.number("rpm", Quantity::RPM) {
        Ok(rpm) => vec![rpm; rows],
        Err(fault) => match table.items("rpm", "") {
            Ok(_) => list(table, "rpm", rows, Quantity::RPM)?,
            Err(_) => return Err(fault),
        },
    };
    let run = Run::new(&readings, &radians_per_second(&rpm)).map_err(|refusal| refused(table, refusal))?;
    Ok((run, readings, rpm))
}

pub(super) fn radians_per_second(rpm: &[f64]) -> Vec<f64> {
    rpm.iter().map(|rpm| rpm * std::f64::consts::TAU / 60.0).collect()
}

/// A refusal at the key that it is about.
pub(super) fn refused(table: &Table<'_>, refusal: Error) -> Diagnostic {
    let (key, expected) = match refusal {
        Error::TrialWeightZero { .. } | Error::Weight { .. } => ("weight", "a weight above zero"),
        Error::SpeedDiffers { .. } => ("rpm", "the speed of the baseline, within 1 %"),
        Error::NoEffect { .. } => ("readings", "readings that the trial weight has changed"),
        _ => ("readings", "other readings"),
    };
    table.wrong(key, format!("{expected} ({refusal})"))
}
