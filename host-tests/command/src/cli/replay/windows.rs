//! Windows of cycles: how long they are, and their table, numbers and page.

use std::f64::consts::TAU;
use std::fmt::Write;

use clap::Args;
use driveline::fluctuation::{Order, Ripple};
use driveline_report::chart::{Curve, Line, Lines, over_time};
use driveline_report::format::{percent, significant};
use driveline_report::{Fact, Figure, Section, Sheet, Table};
use serde_json::{Value, json};

use crate::replay::window::{Windowed, Windows, is_known};

/// Windows in a printed table at most; all of them are in the table of `--csv` and in JSON.
pub const PRINTED: usize = 20;

/// Points of the drawn cycle.
const POINTS: usize = 361;

/// How long windows are.
#[derive(Debug, Args)]
pub struct WindowOptions {
    /// Turns to a cycle, 2 of a four-stroke engine
    #[arg(long, value_name = "TURNS", default_value_t = 1, conflicts_with_all = ["machine", "phasors"],
        value_parser = clap::value_parser!(u32).range(1..=16))]
    cycle: u32,
    /// Cycles to a window
    #[arg(long, value_name = "N", default_value_t = 8, conflicts_with_all = ["machine", "phasors"],
        value_parser = clap::value_parser!(u32).range(1..=65_535))]
    cycles: u32,
    /// Highest order that is fitted, at most a quarter of the teeth in a cycle; no more than the machine excites
    #[arg(long, value_name = "N", default_value_t = 8, conflicts_with_all = ["machine", "phasors"],
        value_parser = clap::value_parser!(u8).range(1..=16))]
    orders: u8,
}

impl WindowOptions {
    /// The windows that are asked for.
    pub fn windows(&self) -> Windows {
        Windows { turns: self.cycle, cycles: self.cycles, orders: usize::from(self.orders) }
    }
}

/// The order with the largest amplitude, and that over the mean.
fn largest(ripple: &Ripple) -> (usize, f64) {
    let amplitudes = ripple.speed.orders.iter().map(|order| order.amplitude() / ripple.speed.mean.abs());
    (1..).zip(amplitudes).max_by(|(_, a), (_, b)| a.total_cmp(b)).unwrap_or_default()
}

/// How many orders were fitted; none where no window is to be used.
pub fn highest(windows: &[Windowed]) -> Option<usize> {
    windows.iter().filter_map(|window| Some(fitted(window.ripple.as_ref().ok()?).len())).max()
}

/// The orders without those that were not asked for, which are 0.
fn fitted(ripple: &Ripple) -> &[Order] {
    let orders = &ripple.speed.orders;
    let last = orders.iter().rposition(|order| order.amplitude() > 0.0);
    &orders[..last.map_or(0, |last| last + 1)]
}

/// Speed over the angle of the cycle (r/min).
fn per_minute(ripple: &Ripple) -> f64 {
    60.0 / TAU * ripple.speed.mean
}

pub fn table(windows: &[Windowed]) -> Table {
    let mut table = Table::new([
        "until s",
        "cycles",
        "speed r/min",
        "delta",
        "deviation",
        "dominant order",
        "residual deg",
        "spread deg",
        "use",
    ]);
    let skipped = windows.len().saturating_sub(PRINTED);
    for Windowed { until, cycles, ripple, doubt } in windows.iter().skip(skipped) {
        let (until, cycles) = (format!("{until:.3}"), cycles.to_string());
        match ripple {
            Ok(ripple) => {
                let (order, amplitude) = largest(ripple);
                table.row([
                    until,
                    cycles,
                    significant(per_minute(ripple)),
                    significant(ripple.motor.delta),
                    significant(ripple.motor.deviation),
                    format!("{order}: {}", percent(amplitude)),
                    significant(ripple.quality.residue.to_degrees()),
                    match ripple.quality.spread {
                        0.0 => "none".to_owned(),
                        spread => significant(spread.to_degrees()),
                    },
                    match doubt {
                        Some(doubt) => format!("doubtful: {doubt}"),
                        None if is_known(ripple) => "yes".to_owned(),
                        None => "the speed alone: three deviations are above 5 % of delta".to_owned(),
                    },
                ]);
            }
            Err(unusable) => {
                let none = || "none".to_owned();
                table.row([until, cycles, none(), none(), none(), none(), none(), none(), format!("no: {unusable}")]);
            }
        }
    }
    table
}

pub fn as_json(window: &Windowed) -> Value {
    match &window.ripple {
        Ok(ripple) => json!({
            "until": window.until,
            "cycles": window.cycles,
            "speed": ripple.speed.mean,
            "speed_by_time": ripple.mean,
            "acceleration": ripple.acceleration,
            "delta": ripple.motor.delta,
            "deviation": ripple.motor.deviation,
            "orders": fitted(ripple).iter().map(|order| {
                json!({ "amplitude": order.amplitude() / ripple.speed.mean.abs(), "phase": order.phase() })
            }).collect::<Vec<_>>(),
            "residue": ripple.quality.residue,
            "doubtful": window.doubt.is_some(),
            "delta_known": is_known(ripple),
            "spread": ripple.quality.spread,
            "missed": ripple.quality.missed,
        }),
        Err(unusable) => json!({ "until": window.until, "cycles": window.cycles, "unusable": unusable.message() }),
    }
}

pub fn csv(windows: &[Windowed]) -> String {
    let mut text = String::from(
        "until_s,cycles,speed_rad_s,acceleration_rad_s2,delta,deviation,residue_rad,spread_rad,doubtful\n",
    );
    for Windowed { until, cycles, ripple, doubt } in windows {
        // writing to a string cannot fail
        let _ = write!(text, "{until:.6},{cycles}");
        let _ = match ripple {
            Ok(Ripple { speed, acceleration, motor, quality, .. }) => {
                let (residue, spread) = (quality.residue, quality.spread);
                let (delta, deviation) = (motor.delta, motor.deviation);
                let doubtful = u8::from(doubt.is_some());
                writeln!(
                    text,
                    ",{:.6e},{acceleration:.6e},{delta:.6e},{deviation:.6e},{residue:.6e},{spread:.6e},{doubtful}",
                    speed.mean
                )
            }
            Err(_) => writeln!(text, ",,,,,,,"),
        };
    }
    text
}

/// Plots over time, the last cycle that is to be used, and the table.
pub fn sheet(windows: &[Windowed], file: &str, kicker: &str, facts: Vec<Fact>) -> Sheet {
    let of = |value: fn(&Ripple) -> f64| -> Vec<f64> {
        windows.iter().map(|window| window.ripple.as_ref().map_or(f64::NAN, value)).collect()
    };
    let times: Vec<f64> = windows.iter().map(|window| window.until).collect();
    let over_time = |title: &str, across: &str, values: Vec<f64>| {
        let line = Line { name: String::new(), class: "s0".to_owned(), values };
        Figure::new(title, "", Vec::new(), vec![over_time(&times, &[line], across, &[])])
    };
    let mut figures = Vec::new();
    if windows.len() > 1 {
        figures.push(over_time("Speed", "speed, r/min", of(per_minute)));
        figures.push(over_time("Fluctuation", "delta", of(|ripple| ripple.motor.delta)));
    }
    let usable = windows.iter().rev().find_map(|window| window.ripple.as_ref().ok());
    if let Some(ripple) = usable {
        let place = |point: usize| point as f64 / (POINTS - 1) as f64;
        let values = (0..POINTS).map(|point| 60.0 / TAU * ripple.speed.at(TAU * place(point))).collect();
        let lines = Lines {
            label: "speed over the cycle".to_owned(),
            along: "cycle".to_owned(),
            across: "speed, r/min".to_owned(),
            places: (0..POINTS).map(place).collect(),
            curves: vec![Curve { class: "s0".to_owned(), values }],
            ..Lines::default()
        };
        let text = "Of the last window that is to be used, by its orders.";
        figures.push(Figure::new("The cycle", text, Vec::new(), vec![lines.draw()]));
    }
    Sheet {
        name: file.to_owned(),
        kicker: kicker.to_owned(),
        summary: "Speed and its fluctuation by the library, over the recording.".to_owned(),
        facts,
        figures,
        tables: vec![Section::new("Windows", "The last ones of the recording.", table(windows))],
    }
}
