//! `cargo driveline replay --teeth`: the toothed wheel over a recording of its edges.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::Path;

use clap::Args;
use driveline::fluctuation::{Order, Ripple};
use driveline_report::chart::{Curve, Lines};
use driveline_report::format::{counted, percent, significant};
use driveline_report::{Fact, Figure, Section, Sheet, Table};
use serde_json::{Value, json};

use super::super::Failure;
use super::shown::Shown;
use crate::recording::{Asked, Quantity, Recording, read_recording};
use crate::replay::wheel::{Turned, Wheel, Windowed, Windows, turn};

/// Windows in a printed table at most; all of them are in the table of `--csv` and in JSON.
const PRINTED: usize = 20;

/// Points of the drawn cycle.
const POINTS: usize = 361;

/// How a wheel is described and read.
#[derive(Debug, Args)]
pub struct WheelOptions {
    /// A wheel instead: `60-2`; `36:10,11,22,23,34,35`, positions of missing teeth; `12+1@340`; `0,70,180,250`, degrees
    #[arg(long, value_name = "WHEEL", conflicts_with_all = ["machine", "phasors"])]
    pub teeth: Option<String>,
    /// Turns of the wheel to a cycle, 2 of a four-stroke engine
    #[arg(long, value_name = "TURNS", default_value_t = 1, conflicts_with_all = ["machine", "phasors"],
        value_parser = clap::value_parser!(u32).range(1..=2))]
    cycle: u32,
    /// Cycles to a window
    #[arg(long, value_name = "N", default_value_t = 8, conflicts_with_all = ["machine", "phasors"],
        value_parser = clap::value_parser!(u32).range(1..=100_000))]
    cycles: u32,
    /// Highest order that is fitted, at most a quarter of the teeth in a cycle; no more than the machine excites
    #[arg(long, value_name = "N", default_value_t = 8, conflicts_with_all = ["machine", "phasors"],
        value_parser = clap::value_parser!(u8).range(1..=16))]
    orders: u8,
}

impl WheelOptions {
    /// Runs the wheel.
    ///
    /// # Errors
    /// A wheel or windows that are refused, a fault of the recording.
    pub fn shown(&self, wheel: &str, file: &Path, mut asked: Asked, falling: bool) -> Result<Shown, Failure> {
        let wheel: Wheel = wheel.parse().map_err(|error| Failure::usage(format!("--teeth {error}")))?;
        let windows = Windows { turns: self.cycle, cycles: self.cycles, orders: usize::from(self.orders) };
        asked.uneven = true;
        let recording = read_recording(file, &asked)?;
        let times = edges(&recording, falling)?;
        let turned = turn(&wheel, windows, &times).map_err(|error| Failure::usage(format!("--teeth: {error}")))?;
        let known = format!("{} of {} edges", turned.known, turned.edges);
        let fitted = turned.windows.iter().filter_map(|window| Some(fitted(window.ripple.as_ref().ok()?).len())).max();
        let mut text = String::new();
        if !turned.windows.is_empty() {
            text = table(&turned).to_string();
        }
        let _ = write!(text, "synchronised at {known}");
        if let Some(highest) = fitted {
            let _ = write!(text, "; orders 1 to {highest} of the cycle fitted");
        }
        if turned.windows.len() > PRINTED {
            let _ = write!(text, "; the last {PRINTED} of {} windows", turned.windows.len());
        }
        if turned.windows.is_empty() {
            let _ = write!(text, "; no cycle: is the wheel the one described, and does it turn above 19 r/min?");
        }
        Ok(Shown {
            text,
            json: json!({
                "file": recording.name,
                "edges": turned.edges,
                "edges_with_place": turned.known,
                "turns_to_a_cycle": windows.turns,
                "windows": turned.windows.iter().map(as_json).collect::<Vec<_>>(),
            }),
            csv: csv(&turned),
            sheet: sheet(&turned, &recording.name, known),
        })
    }
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

/// The order with the largest amplitude, and that over the mean.
fn largest(ripple: &Ripple) -> (usize, f64) {
    let amplitudes = ripple.speed.orders.iter().map(|order| order.amplitude() / ripple.speed.mean);
    (1..).zip(amplitudes).max_by(|(_, a), (_, b)| a.total_cmp(b)).unwrap_or_default()
}

/// Whether the orders leave more of the angle than they explain: the machine turns evenly, or has other orders.
fn is_doubtful(ripple: &Ripple) -> bool {
    let angle = |(n, order): (usize, &Order)| order.amplitude() / ripple.speed.mean / (n + 1) as f64;
    let square: f64 = ripple.speed.orders.iter().enumerate().map(angle).map(|angle| 0.5 * angle * angle).sum();
    ripple.quality.residue > square.sqrt()
}

/// The orders without those that were not asked for, which are 0.
fn fitted(ripple: &Ripple) -> &[Order] {
    let orders = &ripple.speed.orders;
    let last = orders.iter().rposition(|order| order.amplitude() > 0.0);
    &orders[..last.map_or(0, |last| last + 1)]
}

/// Speed over the angle of the cycle [r/min].
fn per_minute(ripple: &Ripple) -> f64 {
    60.0 / TAU * ripple.speed.mean
}

fn table(turned: &Turned) -> Table {
    let mut table = Table::new(["until s", "cycles", "speed r/min", "delta", "dominant order", "residual deg", "use"]);
    let skipped = turned.windows.len().saturating_sub(PRINTED);
    for Windowed { until, cycles, ripple } in turned.windows.iter().skip(skipped) {
        let (until, cycles) = (format!("{until:.3}"), cycles.to_string());
        match ripple {
            Ok(ripple) => {
                let (order, amplitude) = largest(ripple);
                table.row([
                    until,
                    cycles,
                    significant(per_minute(ripple)),
                    significant(ripple.motor.delta),
                    format!("{order}: {}", percent(amplitude)),
                    significant(ripple.quality.residue.to_degrees()),
                    if is_doubtful(ripple) { "doubtful: more is left than the orders explain" } else { "yes" }
                        .to_owned(),
                ]);
            }
            Err(unusable) => {
                let none = || "none".to_owned();
                table.row([until, cycles, none(), none(), none(), none(), format!("no: {unusable}")]);
            }
        }
    }
    table
}

fn as_json(window: &Windowed) -> Value {
    match &window.ripple {
        Ok(ripple) => json!({
            "until": window.until,
            "cycles": window.cycles,
            "speed": ripple.speed.mean,
            "speed_by_time": ripple.mean,
            "acceleration": ripple.acceleration,
            "delta": ripple.motor.delta,
            "orders": fitted(ripple).iter().map(|order| {
                json!({ "amplitude": order.amplitude() / ripple.speed.mean, "phase": order.phase() })
            }).collect::<Vec<_>>(),
            "residue": ripple.quality.residue,
            "doubtful": is_doubtful(ripple),
            "spread": ripple.quality.spread,
            "missed": ripple.quality.missed,
        }),
        Err(unusable) => json!({ "until": window.until, "cycles": window.cycles, "unusable": unusable.message() }),
    }
}

fn csv(turned: &Turned) -> String {
    let mut text = String::from("until_s,cycles,speed_rad_s,acceleration_rad_s2,delta,residue_rad,spread_rad\n");
    for Windowed { until, cycles, ripple } in &turned.windows {
        // writing to a string cannot fail
        let _ = write!(text, "{until:.6},{cycles}");
        let _ = match ripple {
            Ok(Ripple { speed, acceleration, motor, quality, .. }) => {
                let (delta, residue, spread) = (motor.delta, quality.residue, quality.spread);
                writeln!(text, ",{:.6e},{acceleration:.6e},{delta:.6e},{residue:.6e},{spread:.6e}", speed.mean)
            }
            Err(_) => writeln!(text, ",,,,,"),
        };
    }
    text
}

fn sheet(turned: &Turned, file: &str, known: String) -> Sheet {
    let of = |value: fn(&Ripple) -> f64| -> Vec<f64> {
        turned.windows.iter().map(|window| window.ripple.as_ref().map_or(f64::NAN, value)).collect()
    };
    let over_time = |title: &str, across: &str, values: Vec<f64>| Figure {
        title: title.to_owned(),
        plots: vec![
            Lines {
                label: format!("{across} over time"),
                along: "time, s".to_owned(),
                across: across.to_owned(),
                places: turned.windows.iter().map(|window| window.until).collect(),
                curves: vec![Curve { class: "s0".to_owned(), values }],
                ..Lines::default()
            }
            .draw(),
        ],
        ..Figure::default()
    };
    let mut figures = Vec::new();
    if turned.windows.len() > 1 {
        figures.push(over_time("Speed", "speed, r/min", of(per_minute)));
        figures.push(over_time("Fluctuation", "delta", of(|ripple| ripple.motor.delta)));
    }
    let usable = turned.windows.iter().rev().find_map(|window| window.ripple.as_ref().ok());
    if let Some(ripple) = usable {
        let place = |point: usize| point as f64 / (POINTS - 1) as f64;
        let values = (0..POINTS).map(|point| 60.0 / TAU * ripple.speed.at(TAU * place(point))).collect();
        figures.push(Figure {
            title: "The cycle".to_owned(),
            text: "Of the last window that is to be used, by its orders.".to_owned(),
            plots: vec![
                Lines {
                    label: "speed over the cycle".to_owned(),
                    along: "cycle".to_owned(),
                    across: "speed, r/min".to_owned(),
                    places: (0..POINTS).map(place).collect(),
                    curves: vec![Curve { class: "s0".to_owned(), values }],
                    ..Lines::default()
                }
                .draw(),
            ],
            ..Figure::default()
        });
    }
    Sheet {
        name: file.to_owned(),
        kicker: "Toothed wheel".to_owned(),
        summary: "Speed and ripple by the library's wheel, over the recorded edges.".to_owned(),
        facts: vec![Fact { name: "synchronised at".to_owned(), value: known }],
        figures,
        tables: vec![Section::new("Windows", "The last ones of the recording.", table(turned))],
    }
}
