//! `cargo driveline replay --phasors`: the vibration at the rotor's speed.

use std::fmt::Write;
use std::path::Path;

use clap::Args;
use driveline::settings::PhasorSettings;
use driveline_report::chart::{Arrow, polar};
use driveline_report::format::{counted, significant};
use driveline_report::{Figure, Section, Sheet, Table, fact};
use serde_json::{Value, json};

use super::super::Failure;
use super::shown::Shown;
use crate::recording::{Asked, Quantity, read_recording};
use crate::replay::phasors::{Taken, Turning, mean, readings, zero};

/// Largest vibration, whose square is far within single precision.
const HIGHEST: f64 = 1e15;

/// Readings in a printed table at most.
const PRINTED: usize = 20;

/// How a vibration is read.
#[derive(Debug, Args)]
pub struct PhasorOptions {
    /// The phasors of a vibration instead
    #[arg(long)]
    phasors: bool,
    /// Order of the running speed: 1x, 2x and on
    #[arg(long, value_name = "N", default_value_t = 1, conflicts_with_all = ["machine", "teeth", "fluctuation"],
        value_parser = clap::value_parser!(u32).range(1..=15))]
    order: u32,
    /// Turns to a block; a reading has five blocks
    #[arg(long, value_name = "TURNS", default_value_t = 8, conflicts_with_all = ["machine", "teeth", "fluctuation"],
        value_parser = clap::value_parser!(u32).range(1..=100))]
    turns: u32,
    /// End of the sensor's range: a sample there or beyond is clipped [unit of the column]
    #[arg(long, value_name = "VALUE", conflicts_with_all = ["machine", "teeth", "fluctuation"])]
    range: Option<f64>,
}

impl PhasorOptions {
    /// Measures the phasors.
    pub fn shown(&self, file: &Path, asked: Asked, falling: bool) -> Result<Shown, Failure> {
        let recording = read_recording(file, &asked)?;
        let Some(vibration) = recording.signal(Quantity::Vibration) else {
            let expected =
                "a column of the vibration, such as `vibration_mm_per_s`; --column vibration=HEADING names one";
            return Err(recording.fault(recording.found(), expected).into());
        };
        if vibration.len() < 2 {
            return Err(recording.fault(format!("{} samples", vibration.len()), "a recording of some turns").into());
        }
        let mut marks = recording.edges(Quantity::Mark, falling).filter(|marks| !marks.is_empty());
        for (_, since) in marks.iter_mut().flatten() {
            // of two values: half a step ago on average
            *since = if *since == 0.0 { 0.5 } else { *since };
        }
        if falling && recording.signal(Quantity::Mark).is_none() {
            let expected = "a column of a `mark` once a turn; --column mark=HEADING names one";
            return Err(recording.fault("--falling without a column of a mark", expected).into());
        }
        let (turning, origin) = match (recording.signal(Quantity::Angle), &marks) {
            (Some(angle), None) => (Turning::Angle(angle, 0.0), "the angle's"),
            (Some(angle), Some(marks)) => {
                let Some(zero) = zero(angle, marks) else {
                    let found = format!("{} at different angles", counted(marks.len() as u64, "mark"));
                    return Err(recording
                        .fault(found, "a mark at one angle of the rotor, whose angle is recorded")
                        .into());
                };
                (Turning::Angle(angle, zero), "the mark, by the angle")
            }
            (None, Some(marks)) => (Turning::Marks(marks), "the mark"),
            (None, None) => {
                let expected =
                    "a column of the rotor's `angle`, or of a `mark` once a turn; --column mark=HEADING names one";
                return Err(recording.fault(recording.found(), expected).into());
            }
        };
        let settings = PhasorSettings { order: self.order, turns: self.turns, ..PhasorSettings::DIRECT };
        let most = vibration.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let range = self.range.unwrap_or(2.0 * most.max(f64::from(f32::MIN_POSITIVE)));
        if let Some(range) = self.range.filter(|range| !(*range > 0.0 && *range <= HIGHEST)) {
            return Err(Failure::usage(format!("--range {range:?}: expected above zero and at most {HIGHEST:e}")));
        }
        if most > HIGHEST {
            let found = format!("a vibration of {most:e}");
            return Err(recording.fault(found, format!("at most {HIGHEST:e}, as single precision squares it")).into());
        }
        let start = recording.signal(Quantity::Time).and_then(|time| time.first().copied()).unwrap_or(0.0);
        let taken = readings(vibration, turning, &settings, range, [start, recording.period])
            .map_err(|error| Failure::usage(format!("--turns, --order: {}", error.message())))?;
        let mut text = table(&taken).to_string();
        let total = mean(&taken);
        match total {
            Some((mean, apart)) => {
                let (amplitude, phase) = (significant(mean.norm()), mean.arg().to_degrees());
                let apart = significant(apart);
                let _ = write!(text, "mean: {amplitude} at {phase:.1} deg, largest deviation from it {apart}");
            }
            None => text.push_str("no reading is to be used"),
        }
        let _ = write!(text, "; zero of the phase: {origin}");
        if taken.len() > PRINTED {
            let _ = write!(text, "; the last {PRINTED} of {} readings", taken.len());
        }
        let facts = vec![fact("readings", taken.len().to_string())];
        Ok(Shown {
            text,
            json: json!({
                "file": recording.name,
                "rate_hz": 1.0 / recording.period,
                "order": self.order,
                "readings": taken.iter().map(as_json).collect::<Vec<_>>(),
                "mean": total.map(|(mean, apart)| {
                    json!({ "amplitude": mean.norm(), "phase": mean.arg(), "largest_distance": apart })
                }),
            }),
            csv: csv(&taken),
            untold: total.is_none().then(|| "the record tells no phasor".to_owned()),
            sheet: Sheet {
                name: recording.name.clone(),
                kicker: "Phasors".to_owned(),
                summary: "Vibration at the rotor's speed by the library, over the recording.".to_owned(),
                facts,
                figures: arrows(&taken),
                tables: vec![Section::new("Readings", "The last ones of the recording.", table(&taken))],
            },
        })
    }
}

fn table(taken: &[Taken]) -> Table {
    let mut table = Table::new(["until s", "turn/s", "amplitude", "phase deg", "standard deviation", "use"]);
    for taken in &taken[taken.len().saturating_sub(PRINTED)..] {
        let until = format!("{:.3}", taken.until);
        let usable = taken.refused.map_or_else(|| "yes".to_owned(), |fault| format!("no: {fault}"));
        let cells = match &taken.measured {
            Ok(reading) => [
                taken.speed.map_or_else(|| "none".to_owned(), significant),
                significant(f64::from(reading.phasor.re).hypot(f64::from(reading.phasor.im))),
                format!("{:.1}", f64::from(reading.phasor.im).atan2(f64::from(reading.phasor.re)).to_degrees()),
                significant(f64::from(reading.variance).sqrt()),
            ],
            Err(_) => [const { String::new() }; 4].map(|_| "none".to_owned()),
        };
        let [speed, amplitude, phase, deviation] = cells;
        table.row([until, speed, amplitude, phase, deviation, usable]);
    }
    table
}

fn as_json(taken: &Taken) -> Value {
    let reading = taken.measured.as_ref().ok();
    json!({
        "until": taken.until,
        "turns_a_second": taken.speed,
        "phasor": reading.map(|reading| [reading.phasor.re, reading.phasor.im]),
        "variance": reading.map(|reading| reading.variance),
        "refused": taken.refused.map(|fault| fault.to_string()),
    })
}

fn csv(taken: &[Taken]) -> String {
    let mut text = String::from("until_s,re,im,variance,refused\n");
    for taken in taken {
        let until = taken.until;
        let refused = u8::from(taken.refused.is_some());
        // writing to a string cannot fail
        let _ = match &taken.measured {
            Ok(reading) => {
                let [re, im] = [reading.phasor.re, reading.phasor.im];
                writeln!(text, "{until:.6},{re:.6e},{im:.6e},{:.6e},{refused}", reading.variance)
            }
            Err(_) => writeln!(text, "{until:.6},,,,{refused}"),
        };
    }
    text
}

fn arrows(taken: &[Taken]) -> Vec<Figure> {
    let readings = taken.iter().enumerate().filter_map(|(number, taken)| {
        let phasor = taken.phasor()?;
        let (amplitude, degrees) = (phasor.norm(), phasor.arg().to_degrees());
        Some(Arrow { class: "s0", name: format!("reading {}", number + 1), amplitude, degrees })
    });
    let arrows: Vec<Arrow> = readings.collect();
    if arrows.is_empty() {
        return Vec::new();
    }
    let text = "The readings that are to be used, by how far the vibration leads the rotor's zero.";
    vec![Figure::new("Phasors", text, Vec::new(), vec![polar("vibration", "", "phase leads", &arrows)])]
}
