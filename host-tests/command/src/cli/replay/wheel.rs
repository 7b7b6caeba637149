//! `cargo driveline replay --teeth`: the toothed wheel over a recording of its edges.

use std::fmt::Write;
use std::path::Path;

use clap::Args;
use driveline_report::Fact;
use driveline_report::format::{counted, significant};
use serde_json::json;

use super::super::Failure;
use super::shown::Shown;
use super::windows::{PRINTED, as_json, csv, highest, sheet, table};
use crate::recording::{Asked, Quantity, Recording, read_recording};
use crate::replay::wheel::{Turned, Wheel, turn};
use crate::replay::window::Windows;

/// How a wheel is described.
#[derive(Debug, Args)]
pub struct WheelOptions {
    /// A wheel instead: `60-2`; `36:10,11,22,23,34,35`, positions of missing teeth; `12+1@340`; `0,70,180,250`, degrees
    #[arg(long, value_name = "WHEEL")]
    pub teeth: Option<String>,
}

impl WheelOptions {
    /// Runs the wheel.
    ///
    /// # Errors
    /// A wheel or windows that are refused, a fault of the recording.
    pub fn shown(
        &self,
        wheel: &str,
        windows: Windows,
        file: &Path,
        mut asked: Asked,
        falling: bool,
    ) -> Result<Shown, Failure> {
        let wheel: Wheel = wheel.parse().map_err(|error| Failure::usage(format!("--teeth {error}")))?;
        asked.uneven = true;
        let recording = read_recording(file, &asked)?;
        let times = edges(&recording, falling)?;
        let turned = turn(&wheel, windows, &times).map_err(|error| Failure::usage(format!("--teeth: {error}")))?;
        let known = format!("{} of {} edges", turned.known, turned.edges);
        let mut text = String::new();
        if !turned.windows.is_empty() {
            text = table(&turned.windows).to_string();
        }
        let _ = write!(text, "synchronised at {known}");
        if let Some(highest) = highest(&turned.windows) {
            let _ = write!(text, "; orders 1 to {highest} of the cycle fitted");
        }
        if turned.windows.len() > PRINTED {
            let _ = write!(text, "; the last {PRINTED} of {} windows", turned.windows.len());
        }
        // the other edge of a pickup may be the one that its teeth pass at
        let level = recording.signal(Quantity::Teeth);
        let other = level.and_then(|_| turn(&wheel, windows, &edges(&recording, !falling).ok()?).ok());
        let here = unexplained(&turned);
        let better = other.as_ref().and_then(unexplained).filter(|there| here.is_none_or(|here| *there < 0.3 * here));
        if let Some(there) = better {
            let (option, there) = (if falling { "without" } else { "with" }, significant(there.to_degrees()));
            let _ = write!(text, "; {option} --falling the other edges leave a residual of {there} deg");
        }
        if turned.windows.is_empty() {
            let _ = write!(text, "; no cycle: {}", why_none(&turned, windows, &times));
        }
        let fact = Fact { name: "synchronised at".to_owned(), value: known };
        Ok(Shown {
            text,
            json: json!({
                "file": recording.name,
                "edges": turned.edges,
                "edges_with_place": turned.known,
                "turns_to_a_cycle": windows.turns,
                "better_edges": better.map(|residue| json!({ "falling": !falling, "residue": residue })),
                "windows": turned.windows.iter().map(as_json).collect::<Vec<_>>(),
            }),
            csv: csv(&turned.windows),
            untold: highest(&turned.windows).is_none().then(|| "the record tells no speed of this wheel".to_owned()),
            sheet: sheet(&turned.windows, &recording.name, "Toothed wheel", vec![fact]),
        })
    }
}

/// Edges further apart than so many median ones are a stop: a gap is of a few teeth.
const STOP: f64 = 20.0;

/// Why no cycle was found.
fn why_none(turned: &Turned, windows: Windows, times: &[f64]) -> String {
    // a turn to find the place, and the cycle from one gap to the next
    let needed = turned.teeth * (windows.turns as usize + 2);
    let mut steps: Vec<(f64, f64)> = times.windows(2).map(|pair| (pair[1] - pair[0], pair[0])).collect();
    steps.sort_by(|a, b| a.0.total_cmp(&b.0));
    let median = steps.get(steps.len() / 2).map_or(0.0, |step| step.0);
    match steps.last() {
        _ if turned.edges < needed => {
            let (edges, teeth) = (turned.edges, turned.teeth);
            format!("the recording is too short, {edges} edges of {teeth} on a turn, expected {needed} or more")
        }
        Some((longest, since)) if *longest > STOP * median => {
            format!("the edges stay away for {} s from {since:.3} s on", significant(*longest))
        }
        _ => "is the wheel the one described, and does it turn above 19 r/min?".to_owned(),
    }
}

/// Least residue of the windows that are to be used (rad).
fn unexplained(turned: &Turned) -> Option<f64> {
    let residues = turned.windows.iter().filter_map(|window| Some(window.ripple.as_ref().ok()?.quality.residue));
    residues.min_by(f64::total_cmp)
}

/// Times of the edges: of a column of levels, or every row.
fn edges(recording: &Recording, falling: bool) -> Result<Vec<f64>, Failure> {
    let time = |row: usize| match recording.signal(Quantity::Time) {
        Some(time) => time[row],
        None => row as f64 * recording.period,
    };
    let at = |(row, since): (usize, f64)| time(row) - since * (time(row) - time(row - 1));
    let times: Vec<f64> = match recording.edges(Quantity::Teeth, falling) {
        Some(rows) => rows.into_iter().map(at).collect(),
        // a row is an edge where there is nothing else in it
        None if recording.columns.len() == 1 && recording.unused.is_empty() => (0..recording.len()).map(time).collect(),
        None => {
            let expected = "a column of the pickup's level, such as `crank`; --column teeth=HEADING names one";
            return Err(recording.fault(recording.found(), expected).into());
        }
    };
    if times.len() < 2 {
        let found = format!("{} in {}", counted(times.len() as u64, "edge"), recording.found());
        return Err(recording
            .fault(found, "a column of the pickup's level, as `crank`, or a row for each edge")
            .into());
    }
    Ok(times)
}
