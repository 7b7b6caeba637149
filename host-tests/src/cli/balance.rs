//! `cargo driveline balance`: from readings of the field to weights.

use std::path::PathBuf;

use clap::Args;
use driveline::balance::{Aim, Complex, Correction, Holes, Refusal, Tolerance, degrees, from_amplitudes};
use serde::Serialize;

use super::{Failure, say, say_json};
use crate::balance_file::{BalanceFile, Measured, PLANES, ROWS, read};
use crate::report::chart::{Arrow, polar};
use crate::report::format::{percent, significant};
use crate::report::{BalancePage, Fact, PolarFigure, PolarKey, Table, write_page};

/// Weights from the readings of a rotor's runs, what they will leave, and the grade; the page has polar plots.
///
/// The file says the planes, the sensors, a baseline and a trial run for each plane, with phases in degrees.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo driveline balance host-tests/rotors/fan-balance.toml
  cargo driveline balance my.toml --html my.html
  cargo driveline balance my.toml --json")]
pub struct Balance {
    /// The readings: a TOML file
    file: PathBuf,
    /// Where the page goes [default: report/NAME-balance.html]
    #[arg(long, value_name = "PATH")]
    html: Option<PathBuf>,
    /// Print JSON, and write a page only with --html
    #[arg(long)]
    pub json: bool,
}

/// Amplitude and phase.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Polar {
    /// Amplitude, or amount.
    pub amplitude: f64,
    /// Phase, or angle, 0 to 360.
    pub degrees: f64,
}

impl Polar {
    fn of(z: Complex<f64>) -> Self {
        let (amplitude, degrees) = degrees(z);
        Polar { amplitude, degrees }
    }

    fn told(self) -> [String; 2] {
        [significant(self.amplitude), if self.amplitude > 0.0 { format!("{:.1}", self.degrees) } else { String::new() }]
    }
}

/// A reading before and after.
#[derive(Clone, Debug, Serialize)]
struct Row {
    sensor: String,
    rpm: f64,
    baseline: Polar,
    now: Polar,
    predicted: Polar,
    #[serde(skip_serializing_if = "Option::is_none")]
    predicted_with_holes: Option<Polar>,
}

/// A plane and its weight.
#[derive(Clone, Debug, Serialize)]
struct Plane {
    plane: String,
    /// The weight to add.
    weight: Polar,
    #[serde(skip_serializing_if = "Option::is_none")]
    holes: Option<Vec<Hole>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    left_out: Option<String>,
}

/// What goes into a hole, or comes out of it.
#[derive(Clone, Debug, Serialize)]
struct Hole {
    hole: usize,
    degrees: f64,
    weight: f64,
}

/// The grade before and after.
#[derive(Clone, Debug, Serialize)]
struct Grade {
    permissible_g_mm: f64,
    now_g_mm: f64,
    now_grade: f64,
    predicted_g_mm: f64,
    predicted_grade: f64,
    passed: bool,
}

/// All that comes out.
#[derive(Clone, Debug, Serialize)]
struct Outcome {
    name: String,
    unit: String,
    weight_unit: &'static str,
    /// Corrections that are on already; what follows is then a trim.
    corrections: usize,
    condition: f64,
    rows: Vec<Row>,
    planes: Vec<Plane>,
    #[serde(skip_serializing_if = "Option::is_none")]
    grade: Option<Grade>,
}

impl Balance {
    /// Reads the file and shows the weights.
    ///
    /// # Errors
    /// A file with a fault; readings that no weights follow from; a page that cannot be written.
    pub fn execute(&self) -> Result<(), Failure> {
        let file = read(&self.file)?;
        let refused = |refusal: Refusal| Failure::failed(format!("{}: {refusal}", self.file.display()));
        if let Measured::Amplitudes { baseline, weight, runs } = &file.measured {
            return self.amplitudes(&file, *baseline, *weight, runs);
        }
        let outcome = outcome(&file).map_err(refused)?;
        let slug: String =
            file.name.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' }).collect();
        let usual = (!self.json).then(|| PathBuf::from(format!("report/{slug}-balance.html")));
        let path = self.html.clone().or(usual);
        if let Some(path) = &path {
            write_page(path, &page(&outcome).page())
                .map_err(|error| Failure::failed(format!("{} cannot be written: {error}", path.display())))?;
        }
        if self.json {
            return say_json(&outcome);
        }
        say(format_args!("{}\n", summary(&outcome)));
        for (title, _, table) in tables(&outcome) {
            say(format_args!("{title}\n{table}"));
        }
        for fact in facts(&outcome) {
            say(format_args!("{}: {}", fact.name, fact.value));
        }
        if let Some(path) = path {
            say(format_args!("page: {}", path.display()));
        }
        Ok(())
    }

    fn amplitudes(&self, file: &BalanceFile, baseline: f64, weight: f64, runs: &[(f64, f64)]) -> Result<(), Failure> {
        let radians: Vec<(f64, f64)> =
            runs.iter().map(|(degrees, amplitude)| (degrees.to_radians(), *amplitude)).collect();
        let found = from_amplitudes(baseline, weight, &radians)
            .map_err(|refusal| Failure::failed(format!("{}: {refusal}", self.file.display())))?;
        let weights: Vec<Polar> = [Some(found.weight), found.or].into_iter().flatten().map(Polar::of).collect();
        if self.json {
            return say_json(&serde_json::json!({
                "name": file.name, "weight_unit": file.weight_unit.name(), "weights": weights,
                "disagreement": found.disagreement,
            }));
        }
        let unit = file.weight_unit.name();
        for (index, polar) in weights.iter().enumerate() {
            let [amount, angle] = polar.told();
            say(format_args!("{}{amount} {unit} at {angle}°", if index == 0 { "add " } else { "or  " }));
        }
        if weights.len() > 1 {
            say("Two trial runs leave two answers: try one, or make a third run.");
        } else {
            say(format_args!(
                "the runs contradict each other by {} of the trial weight's effect",
                percent(found.disagreement)
            ));
        }
        Ok(())
    }
}

fn outcome(file: &BalanceFile) -> Result<Outcome, Refusal> {
    let Measured::Phasors { procedure, baseline, last, rpm, corrections } = &file.measured else {
        return Err(Refusal::TooEarly);
    };
    let correction: Correction<f64, ROWS, PLANES> = procedure.correction()?;
    let influence = procedure.influence()?;
    let mut placed = correction.weights;
    let mut planes = Vec::new();
    for (plane, name) in file.planes.iter().enumerate() {
        let mut fitted = None;
        if let Some(holes) = file.holes.iter().find(|holes| holes.plane == plane) {
            let angles: Vec<f64> = holes.degrees.iter().map(|degrees| degrees.to_radians()).collect();
            let found =
                Holes { angles: &angles, weights: &holes.weights, mode: holes.mode }
                    .fit(correction.weights[plane])
                    .map_err(|refusal| {
                        if let Refusal::TooHeavy { .. } = refusal { Refusal::TooHeavy { plane } } else { refusal }
                    })?;
            placed[plane] = found.sum;
            let used = found.holes.into_iter().filter(|(_, weight)| *weight > 0.0);
            fitted = Some(
                used.map(|(hole, weight)| Hole { hole: hole + 1, degrees: holes.degrees[hole], weight }).collect(),
            );
        }
        let out = correction.left_out.iter().find(|out| out.plane == plane);
        planes.push(Plane {
            plane: name.clone(),
            weight: Polar::of(correction.weights[plane]),
            holes: fitted,
            left_out: out.map(|out| {
                let like: Vec<String> = (file.planes.iter().zip(&out.like))
                    .filter(|(_, weight)| weight.norm() > 1e-3)
                    .map(|(name, weight)| {
                        let [amount, angle] = Polar::of(*weight).told();
                        format!("{amount} at {angle}° in {name}")
                    })
                    .collect();
                format!(
                    "not used: one here does the same as {}; {} of it is its own",
                    like.join(" and "),
                    percent(out.own)
                )
            }),
        });
    }
    let with_holes = (!file.holes.is_empty()).then(|| influence.predict(last, &placed)).transpose()?;
    // what rounding leaves of the largest reading is none
    let most = last.iter().map(|value| value.norm()).fold(0.0, f64::max);
    let left =
        |value: Complex<f64>| Polar::of(if value.norm() < 1e-12 * most { Complex::new(0.0, 0.0) } else { value });
    let rows = (0..file.sensors.len())
        .map(|row| Row {
            sensor: file.sensors[row].clone(),
            rpm: rpm[row],
            baseline: Polar::of(baseline[row]),
            now: Polar::of(last[row]),
            predicted: left(correction.residual[row]),
            predicted_with_holes: with_holes.map(|rows| left(rows[row])),
        })
        .collect();
    Ok(Outcome {
        name: file.name.clone(),
        unit: file.unit.clone(),
        weight_unit: file.weight_unit.name(),
        corrections: *corrections,
        condition: correction.condition,
        rows,
        planes,
        // What the rotor's unbalance is, limits and objective aside.
        grade: grade(file, &influence.correct(last, &Aim::default())?.weights, &placed)?,
    })
}

/// Unbalance now is what the weights would take away; what is left is what they are off by, each plane by its own size.
fn grade(file: &BalanceFile, wanted: &[Complex<f64>], placed: &[Complex<f64>]) -> Result<Option<Grade>, Refusal> {
    let Some(rotor) = file.rotor else { return Ok(None) };
    let Some(unbalance) = file.weight_unit.unbalance(rotor.radius) else { return Ok(None) };
    let tolerance = Tolerance { grade: rotor.grade, mass: rotor.mass, speed: rotor.rpm * std::f64::consts::TAU / 60.0 };
    let now: f64 = wanted.iter().map(|weight| weight.norm() * unbalance).sum();
    let left: f64 = wanted.iter().zip(placed).map(|(wanted, placed)| (wanted - placed).norm() * unbalance).sum();
    let (before, after) = (tolerance.judge(now)?, tolerance.judge(left)?);
    Ok(Some(Grade {
        permissible_g_mm: tolerance.permissible()? * 1e6,
        now_g_mm: now * 1e6,
        now_grade: before.grade,
        predicted_g_mm: left * 1e6,
        predicted_grade: after.grade,
        passed: after.passed,
    }))
}

fn largest(rows: &[Row], of: impl Fn(&Row) -> Polar) -> f64 {
    rows.iter().map(|row| of(row).amplitude).fold(0.0, f64::max)
}

fn summary(outcome: &Outcome) -> String {
    let now = largest(&outcome.rows, |row| row.now);
    let after = largest(&outcome.rows, |row| row.predicted_with_holes.unwrap_or(row.predicted));
    let what = if outcome.corrections == 0 { "With these weights" } else { "With this trim" };
    format!("{what} the largest vibration goes from {} to {} {}.", significant(now), significant(after), outcome.unit)
}

fn facts(outcome: &Outcome) -> Vec<Fact> {
    let fact = |name: &str, value: String| Fact { name: name.to_owned(), value };
    let mut facts = vec![fact("condition of the planes", significant(outcome.condition))];
    if let Some(grade) = &outcome.grade {
        let unbalance = |g_mm: f64, grade: f64| format!("{} g mm, G {}", significant(g_mm), significant(grade));
        facts.push(fact("unbalance now", unbalance(grade.now_g_mm, grade.now_grade)));
        facts.push(fact("unbalance predicted", unbalance(grade.predicted_g_mm, grade.predicted_grade)));
        let verdict = if grade.passed { "within it" } else { "beyond it" };
        facts.push(fact("permissible", format!("{} g mm: {verdict}", significant(grade.permissible_g_mm))));
    }
    facts
}

/// The tables as title, explanation and table: for the terminal and the page alike.
fn tables(outcome: &Outcome) -> Vec<(String, String, Table)> {
    let mut weights = Table::new(["plane", &format!("add {}", outcome.weight_unit), "at °", "holes"]);
    for plane in &outcome.planes {
        let holes = match (&plane.left_out, &plane.holes) {
            (Some(reason), _) => reason.clone(),
            (None, None) => String::new(),
            (None, Some(holes)) if holes.is_empty() => "none: too light".to_owned(),
            (None, Some(holes)) => holes
                .iter()
                .map(|hole| {
                    format!("{} in hole {} ({}°)", significant(hole.weight), hole.hole, significant(hole.degrees))
                })
                .collect::<Vec<_>>()
                .join(", "),
        };
        let [amount, angle] = plane.weight.told();
        weights.row([plane.plane.clone(), amount, angle, holes]);
    }
    let mut rows = Table::new(["reading", "rpm", "baseline", "°", "now", "°", "predicted", "°", "with holes", "°"]);
    for row in &outcome.rows {
        let fitted = row.predicted_with_holes.map_or_else(|| [String::new(), String::new()], Polar::told);
        let polar = [row.baseline, row.now, row.predicted].into_iter().flat_map(Polar::told);
        rows.row([row.sensor.clone(), significant(row.rpm)].into_iter().chain(polar).chain(fitted));
    }
    let unit = if outcome.unit.is_empty() { String::new() } else { format!(" [{}]", outcome.unit) };
    vec![
        (
            "Weights".to_owned(),
            "To be added to what is on the rotor now, angles as those of the trial weights.".to_owned(),
            weights,
        ),
        (format!("Vibration{unit}"), "As predicted from the influence of the trial weights.".to_owned(), rows),
    ]
}

fn page(outcome: &Outcome) -> BalancePage {
    let arrow = |class, name: &str, polar: Polar| Arrow {
        class,
        name: name.to_owned(),
        amplitude: polar.amplitude,
        degrees: polar.degrees,
    };
    let vibration = |row: &Row| {
        let mut arrows = vec![arrow("s5", "baseline", row.baseline), arrow("s1", "now", row.now)];
        arrows.push(arrow("s2", "predicted", row.predicted_with_holes.unwrap_or(row.predicted)));
        polar(&format!("{}, {} rpm", row.sensor, significant(row.rpm)), &outcome.unit, &arrows)
    };
    let weight = |plane: &Plane| {
        let mut arrows = vec![arrow("s0", "weight", plane.weight)];
        for hole in plane.holes.iter().flatten() {
            let polar = Polar { amplitude: hole.weight, degrees: hole.degrees };
            arrows.push(arrow("s3", &format!("hole {}", hole.hole), polar));
        }
        polar(&plane.plane, outcome.weight_unit, &arrows)
    };
    let key = |name, class| PolarKey { name, class };
    BalancePage {
        name: outcome.name.clone(),
        summary: summary(outcome),
        facts: facts(outcome),
        figures: vec![
            PolarFigure {
                title: "Weights".to_owned(),
                text: "What is to be added in each plane, and what goes into which hole.".to_owned(),
                legend: vec![key("weight", "s0"), key("in a hole", "s3")],
                plots: outcome.planes.iter().map(weight).collect(),
            },
            PolarFigure {
                title: "Vibration".to_owned(),
                text: "Amplitude and phase of each reading: at the beginning, now, and as predicted.".to_owned(),
                legend: vec![key("baseline", "s5"), key("now", "s1"), key("predicted", "s2")],
                plots: outcome.rows.iter().map(vibration).collect(),
            },
        ],
        tables: tables(outcome),
    }
}
