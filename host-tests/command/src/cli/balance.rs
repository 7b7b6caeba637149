//! `cargo driveline balancing`: from readings of the field to weights.

mod amplitudes;
mod fault;
mod grade;
mod weight;

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use driveline::balancing::{Aim, Complex, Correction, Error};
use serde::Serialize;

use super::results::{Destination, check};
use super::{Failure, say, say_json};
use crate::machine_file::balance::{BalanceFile, Measured, PLANES, ROWS, read};
use driveline_report::chart::polar;
use driveline_report::format::{percent, significant};
use driveline_report::{Arrangement, Fact, Figure, Key, Section, Sheet, Table};

use fault::Fault;
use grade::{Grade, grade};
pub use weight::Polar;
use weight::{Hole, arrow, arrows_of, fill, told};

/// Correction weights from the readings of a rotor's runs, the predicted residual, and the grade; the page has polar
/// plots.
///
/// The file has the planes, the sensors, a baseline and a trial run for each plane, with phases in degrees.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo driveline example fan-balance > fan-balance.toml
  cargo driveline balancing fan-balance.toml
  cargo driveline balancing my.toml --html my.html
  cargo driveline balancing my.toml --json")]
pub struct Balance {
    /// The readings: a TOML file
    file: PathBuf,
    /// File of the page [default: report/NAME-balancing.html]
    #[arg(long, value_name = "PATH")]
    html: Option<PathBuf>,
    /// Print JSON, and write a page only with --html
    #[arg(long)]
    pub json: bool,
}

/// A reading before and after.
#[derive(Clone, Debug, Serialize)]
struct Row {
    sensor: String,
    rpm: f64,
    /// Whether it counts: a reading that is weighted with zero does not.
    counts: bool,
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
        if let Measured::Amplitudes { baseline, found } = &file.measured {
            let found = amplitudes::outcome(&file, *baseline, found).map_err(|fault| self.said(fault))?;
            return self.show(&file, &found, &found.said(), || found.page());
        }
        let outcome = outcome(&file).map_err(|fault| self.said(fault))?;
        self.show(&file, &outcome, &said(&outcome), || page(&outcome))
    }

    fn said(&self, fault: Fault) -> Failure {
        match fault {
            Fault::Placed(diagnostic) => diagnostic.into(),
            Fault::Refused(refusal) => Failure::failed(format!("{}: {refusal}", self.file.display())),
        }
    }

    /// Prints JSON or what there is to say, and writes the page.
    fn show(
        &self,
        file: &BalanceFile,
        outcome: &impl Serialize,
        said: &str,
        page: impl FnOnce() -> Sheet,
    ) -> Result<(), Failure> {
        let slug: String =
            file.name.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' }).collect();
        let file = Destination::page_unless(self.json, self.html.as_deref(), &format!("{slug}-balancing"));
        check(&[&self.file], &file)?;
        if self.json {
            say_json(outcome)?;
        } else {
            say(said);
        }
        file.map_or(Ok(()), |file| file.write_and_say(&page().page(), self.json))
    }
}

/// All that is said on the terminal.
fn said(outcome: &Outcome) -> String {
    let mut said = format!("{}\n\n", summary(outcome));
    for section in tables(outcome) {
        let _ = writeln!(said, "{section}");
    }
    for fact in facts(outcome) {
        let _ = writeln!(said, "{}: {}", fact.name, fact.value);
    }
    said.trim_end().to_owned()
}

fn outcome(file: &BalanceFile) -> Result<Outcome, Fault> {
    let Measured::Phasors { procedure, baseline, last, rpm, corrections } = &file.measured else {
        return Err(Error::TooEarly.into());
    };
    let correction: Correction<f64, ROWS, PLANES> = procedure.correction()?;
    let influence = procedure.influence()?;
    let mut placed = correction.weights;
    let mut planes = Vec::new();
    for (plane, name) in file.planes.iter().enumerate() {
        let mut fitted = None;
        if let Some(holes) = file.holes.iter().find(|holes| holes.plane == plane) {
            let (sum, used) = fill(holes, correction.weights[plane])?;
            placed[plane] = sum;
            fitted = Some(used);
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
                if like.is_empty() {
                    return "not used: a weight here changes no reading that counts".to_owned();
                }
                format!(
                    "not used: one here does the same as {}; {} of it is its own",
                    like.join(" and "),
                    percent(out.own)
                )
            }),
        });
    }
    let with_holes = (!file.holes.is_empty()).then(|| influence.predict(last, &placed)).transpose()?;
    // rounding of the largest reading counts as zero
    let most = last.iter().map(|value| value.norm()).fold(0.0, f64::max);
    let left =
        |value: Complex<f64>| Polar::of(if value.norm() < 1e-12 * most { Complex::new(0.0, 0.0) } else { value });
    let rows = (0..file.sensors.len())
        .map(|row| Row {
            sensor: file.sensors[row].clone(),
            rpm: rpm[row],
            counts: procedure.plan().aim.weighting[row] > 0.0,
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
        // The rotor's unbalance, limits and objective aside.
        grade: grade(file, &influence.correct(last, &Aim::default())?.weights, &placed)?,
    })
}

fn largest(rows: &[Row], of: impl Fn(&Row) -> Polar) -> f64 {
    rows.iter().filter(|row| row.counts).map(|row| of(row).amplitude).fold(0.0, f64::max)
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
    facts.extend(outcome.grade.iter().flat_map(Grade::facts));
    facts
}

/// The tables as title, explanation and table: for the terminal and the page alike.
fn tables(outcome: &Outcome) -> Vec<Section> {
    let mut weights = Table::new(["plane", &format!("add {}", outcome.weight_unit), "at °", "holes"]);
    for plane in &outcome.planes {
        let holes = plane.left_out.clone().unwrap_or_else(|| told(plane.holes.as_deref()));
        let [amount, angle] = plane.weight.told();
        weights.row([plane.plane.clone(), amount, angle, holes]);
    }
    let mut rows = Table::new(["reading", "rpm", "baseline", "°", "now", "°", "predicted", "°", "with holes", "°"]);
    for row in &outcome.rows {
        let fitted = row.predicted_with_holes.map_or_else(|| [String::new(), String::new()], Polar::told);
        let polar = [row.baseline, row.now, row.predicted].into_iter().flat_map(Polar::told);
        let name = if row.counts { row.sensor.clone() } else { format!("{} (left out)", row.sensor) };
        rows.row([name, significant(row.rpm)].into_iter().chain(polar).chain(fitted));
    }
    let unit = if outcome.unit.is_empty() { String::new() } else { format!(" [{}]", outcome.unit) };
    vec![
        Section::new(
            "Weights",
            "To be added to the weights now on the rotor; angles as those of the trial weights.",
            weights,
        ),
        Section::new(format!("Vibration{unit}"), "As predicted from the influence of the trial weights.", rows),
    ]
}

fn page(outcome: &Outcome) -> Sheet {
    let vibration = |row: &Row| {
        let mut arrows = vec![arrow("s5", "baseline", row.baseline), arrow("s1", "now", row.now)];
        arrows.push(arrow("s2", "predicted", row.predicted_with_holes.unwrap_or(row.predicted)));
        polar(&format!("{}, {} rpm", row.sensor, significant(row.rpm)), &outcome.unit, &arrows)
    };
    let weight = |plane: &Plane| {
        let arrows = arrows_of(plane.weight, plane.holes.as_deref());
        polar(&plane.plane, outcome.weight_unit, &arrows)
    };
    Sheet {
        name: outcome.name.clone(),
        kicker: "balancing".to_owned(),
        summary: summary(outcome),
        facts: facts(outcome),
        figures: vec![
            Figure {
                title: "Weights".to_owned(),
                text: "Weight to add in each plane, and its split between holes.".to_owned(),
                legend: vec![Key::arrow("weight", "s0"), Key::arrow("in a hole", "s3")],
                plots: outcome.planes.iter().map(weight).collect(),
                arrangement: Arrangement::Beside,
            },
            Figure {
                title: "Vibration".to_owned(),
                text: "Amplitude and phase of each reading: at the beginning, now, and as predicted.".to_owned(),
                legend: vec![Key::arrow("baseline", "s5"), Key::arrow("now", "s1"), Key::arrow("predicted", "s2")],
                plots: outcome.rows.iter().map(vibration).collect(),
                arrangement: Arrangement::Beside,
            },
        ],
        tables: tables(outcome),
    }
}
