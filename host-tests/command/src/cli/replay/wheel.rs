//! `cargo driveline replay --teeth`: the toothed wheel over a recording of its edges.

use std::fmt::Write;
use std::path::Path;

use clap::Args;
use driveline_report::fact;
use driveline_report::format::{counted, significant};
use serde_json::json;

use super::super::Failure;
use super::shown::Shown;
use super::windows::{PRINTED, as_json, csv, highest, sheet, table};
use crate::recording::{Asked, Quantity, Recording, read_recording};
use crate::replay::wheel::{Followed, Turned, Wheel, follow, turn};
use crate::replay::window::Windows;

/// How a wheel is described.
#[derive(Debug, Args)]
pub struct WheelOptions {
    /// A wheel instead: `60-2`; `36:10,11,22,23,34,35`, positions of missing teeth; `12+1@340`; `0,70,180,250`, degrees
    #[arg(long, value_name = "WHEEL", conflicts_with_all = ["fluctuation", "phasors"])]
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
        let wheel = described(wheel)?;
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
        // the edges of a pickup may end before its level does
        let end = recording.len().checked_sub(1).map(|row| time(&recording, row));
        let (stop, _) = median_step(&times);
        let faded = end.zip(times.last()).filter(|(end, last)| end - *last > STOP * stop).map(|(_, last)| *last);
        let lost = turned.lost.or(faded.filter(|_| turned.known > 0));
        if let Some(lost) = lost {
            let _ = write!(text, "; lost first after {lost:.3} s");
        }
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
        let fact = fact("synchronised at", known);
        Ok(Shown {
            text,
            json: json!({
                "file": recording.name,
                "edges": turned.edges,
                "edges_with_place": turned.known,
                "lost_after": lost,
                "turns_to_a_cycle": windows.turns,
                "better_edges": better.map(|residue| json!({ "falling": !falling, "residue": residue })),
                "windows": turned.windows.iter().map(as_json).collect::<Vec<_>>(),
            }),
            csv: csv(&turned.windows),
            untold: highest(&turned.windows).is_none().then(|| "the record tells no speed of this wheel".to_owned()),
            sheet: sheet(&turned.windows, &recording.name, "Toothed wheel", vec![fact]),
        })
    }

    /// The wheel's angle in the rows of a recording.
    ///
    /// # Errors
    /// A wheel that is refused, a recording without edges or one whose edges are not those of the wheel.
    pub fn followed(wheel: &str, recording: &Recording, falling: bool) -> Result<Followed, Failure> {
        let described = described(wheel)?;
        let times: Vec<f64> = (0..recording.len()).map(|row| time(recording, row)).collect();
        let edges = edges(recording, falling)?;
        let followed =
            follow(&described, &edges, &times).map_err(|error| Failure::usage(format!("--teeth: {error}")))?;
        if followed.known() == 0 {
            let found = format!("{} that give no angle of the wheel {wheel}", counted(edges.len() as u64, "edge"));
            return Err(recording.fault(found, "those of two turns or more of the wheel that is described").into());
        }
        Ok(followed)
    }
}

fn described(wheel: &str) -> Result<Wheel, Failure> {
    wheel.parse().map_err(|error| Failure::usage(format!("--teeth {error}")))
}

/// Edges further apart than so many median ones are a stop: a gap is of a few teeth.
const STOP: f64 = 20.0;

/// The median time from edge to edge (s), and all of them in order with the edge that each begins at.
fn median_step(times: &[f64]) -> (f64, Vec<(f64, f64)>) {
    let mut steps: Vec<(f64, f64)> = times.windows(2).map(|pair| (pair[1] - pair[0], pair[0])).collect();
    steps.sort_by(|a, b| a.0.total_cmp(&b.0));
    (steps.get(steps.len() / 2).map_or(0.0, |step| step.0), steps)
}

/// Why no cycle was found.
fn why_none(turned: &Turned, windows: Windows, times: &[f64]) -> String {
    // a turn to find the place, and the cycle from one gap to the next
    let needed = turned.teeth * (windows.turns as usize + 2);
    let (median, steps) = median_step(times);
    let at_once = steps.iter().filter(|step| step.0 == 0.0).count();
    match steps.last() {
        _ if turned.edges < needed => {
            let (edges, teeth) = (turned.edges, turned.teeth);
            format!("the recording is too short, {edges} edges of {teeth} on a turn, expected {needed} or more")
        }
        _ if median == 0.0 => {
            format!("{at_once} of {} edges are at the time of the one before, expected a finer clock", turned.edges)
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

/// Time of a row (s).
fn time(recording: &Recording, row: usize) -> f64 {
    recording.signal(Quantity::Time).map_or_else(|| row as f64 * recording.period, |time| time[row])
}

/// Times of the edges: a column of their own, a column of levels, or every row.
fn edges(recording: &Recording, falling: bool) -> Result<Vec<f64>, Failure> {
    let time = |row: usize| time(recording, row);
    let at = |(row, since): (usize, f64)| {
        // of two values sampled evenly: half a step ago on average
        let since = if since == 0.0 && recording.period.is_finite() { 0.5 } else { since };
        time(row) - since * (time(row) - time(row - 1))
    };
    let level = recording.edges(Quantity::Teeth, falling);
    if falling && level.is_none() {
        return Err(recording.fault("--falling without a pickup's level", "a column of it, such as `crank`").into());
    }
    let times: Vec<f64> = match (recording.signal(Quantity::ToothTime), level) {
        (Some(_), Some(_)) => {
            let expected = "one of the two; --column names the other quantities";
            return Err(recording.fault("times of teeth beside a pickup's level", expected).into());
        }
        (Some(_), None) if recording.period.is_finite() && recording.signal(Quantity::Time).is_none() => {
            let expected = "a column of `time` on their clock";
            return Err(recording.fault("times of teeth beside rows without a time", expected).into());
        }
        (Some(times), None) => times.to_vec(),
        (None, Some(rows)) => rows.into_iter().map(at).collect(),
        // a row is an edge where there is nothing else in it
        (None, None) if recording.columns.len() == 1 && recording.unused.is_empty() => {
            (0..recording.len()).map(time).collect()
        }
        (None, None) => {
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
