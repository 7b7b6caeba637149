//! `cargo driveline replay --fluctuation`: the speed's fluctuation from a recorded angle.

use std::fmt::Write;
use std::path::Path;

use clap::Args;
use driveline_report::format::counted;
use serde_json::json;

use super::super::Failure;
use super::shown::Shown;
use super::windows::{PRINTED, as_json, csv, highest, sheet, table};
use crate::recording::{Asked, Quantity, read_recording};
use crate::replay::fluctuation::measure;
use crate::replay::window::Windows;

/// What is asked of an angle.
#[derive(Debug, Args)]
pub struct FluctuationOptions {
    /// The fluctuation of the speed instead, from a recorded angle
    #[arg(long, conflicts_with = "phasors")]
    pub fluctuation: bool,
}

impl FluctuationOptions {
    /// Measures the fluctuation.
    ///
    /// # Errors
    /// A fault of the recording, a cycle that the library refuses.
    pub fn shown(windows: Windows, file: &Path, asked: Asked) -> Result<Shown, Failure> {
        let recording = read_recording(file, &asked)?;
        let Some(angle) = recording.signal(Quantity::Angle).filter(|angle| angle.len() > 1) else {
            let expected = "two samples or more of the motor's angle, such as `angle_rad`; --column angle=HEADING";
            return Err(recording.fault(recording.found(), expected).into());
        };
        let start = recording.signal(Quantity::Time).and_then(|time| time.first().copied()).unwrap_or(0.0);
        let found = measure(angle, [start, recording.period], windows)
            .map_err(|error| Failure::usage(format!("--cycle, --cycles: {error}")))?;
        let mut text = String::new();
        if !found.is_empty() {
            text = table(&found).to_string();
        }
        // writing to a string cannot fail
        let _ = match highest(&found) {
            Some(highest) => write!(text, "orders 1 to {highest} of the cycle fitted"),
            None if found.is_empty() => {
                let (cycles, turns) = (windows.cycles, counted(windows.turns.into(), "turn"));
                let needed =
                    "all turned one way, from an end of a cycle on, with 12 or 18 samples to a quarter of a turn";
                write!(text, "no window of {cycles} cycles of {turns}: {needed}")
            }
            None => write!(text, "no window is to be used"),
        };
        if found.len() > PRINTED {
            let _ = write!(text, "; the last {PRINTED} of {} windows", found.len());
        }
        Ok(Shown {
            text,
            json: json!({
                "file": recording.name,
                "rate_hz": 1.0 / recording.period,
                "turns_to_a_cycle": windows.turns,
                "windows": found.iter().map(as_json).collect::<Vec<_>>(),
            }),
            csv: csv(&found),
            untold: highest(&found).is_none().then(|| "the record tells no fluctuation".to_owned()),
            sheet: sheet(&found, &recording.name, "Speed fluctuation", Vec::new()),
        })
    }
}
