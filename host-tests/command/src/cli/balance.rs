//! `cargo driveline balancing`: from readings of the field to weights.

mod amplitudes;
#[cfg(not(target_family = "wasm"))]
mod command;
mod fault;
mod grade;
mod weight;

use std::fmt::Write as _;

use driveline::balancing::{Aim, Complex, Correction, Error, Influence};
use serde::Serialize;

use super::Failure;
use crate::machine_file::balance::{AngleConvention, BalanceFile, Measured, PLANES, ROWS};
use driveline_report::chart::polar;
use driveline_report::format::{percent, significant, turned};
use driveline_report::{Arrangement, Fact, Figure, Key, Section, Sheet, Table, fact};

#[cfg(not(target_family = "wasm"))]
pub use command::Balance;
use fault::Fault;
use grade::{Grade, grade};
pub use weight::Polar;
use weight::{Hole, arrow, arrows_of, fill, told};

/// A reading before and after.
#[derive(Clone, Debug, Serialize)]
struct Row {
    sensor: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    rpm: Option<f64>,
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
    /// All weight that is then in the plane: corrections, trial weights that stay, and this one.
    total: Polar,
    #[serde(skip_serializing_if = "Option::is_none")]
    holes: Option<Vec<Hole>>,
    /// The weight at two given angles; a negative one is to be taken off there.
    #[serde(skip_serializing_if = "Option::is_none")]
    split: Option<[Share; 2]>,
    /// Largest vibration predicted without this plane.
    #[serde(skip_serializing_if = "Option::is_none")]
    largest_without: Option<f64>,
    /// Influence of a weight of one on each reading.
    coefficients: Vec<Polar>,
    /// The largest change of a reading by the trial weight, over what it was.
    #[serde(skip_serializing_if = "Option::is_none")]
    change_by_trial: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    left_out: Option<String>,
}

/// Change of a reading of which an error of 5 % in that reading is a half.
const SLIGHT: f64 = 0.1;

/// Part of the change by the corrections that they may miss it by: more is no error of a reading.
const MISSED: f64 = 0.5;

/// A share of a weight at a given angle.
#[derive(Clone, Copy, Debug, Serialize)]
struct Share {
    weight: f64,
    degrees: f64,
}

/// All that comes out.
#[derive(Clone, Debug, Serialize)]
struct Outcome {
    name: String,
    unit: String,
    weight_unit: &'static str,
    #[serde(skip)]
    angles: AngleConvention,
    /// Corrections that are on already; what follows is then a trim.
    corrections: usize,
    condition: f64,
    rows: Vec<Row>,
    planes: Vec<Plane>,
    /// Where the corrections did not do what the coefficients say: the largest vibration, found and expected.
    missed: Option<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    grade: Option<Grade>,
}

/// The page of weights.
///
/// # Errors
/// Readings that no weights follow from, with the place in the file where there is one.
pub fn answered(file: &BalanceFile) -> Result<String, Failure> {
    let failed = |fault| match fault {
        Fault::Placed(diagnostic) => Failure::from(diagnostic),
        Fault::Refused(refusal) => Failure::failed(refusal.to_string()),
    };
    let sheet = match &file.measured {
        Measured::Amplitudes { baseline, found } => amplitudes::outcome(file, *baseline, found).map(|it| it.page()),
        _ => outcome(file).map(|outcome| page(&outcome)),
    };
    Ok(sheet.map_err(failed)?.page())
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
    let _ = write!(said, "\nInfluence coefficients, for a file without trial runs:\n{}", coefficients(outcome));
    said.trim_end().to_owned()
}

/// The influence coefficients as a file takes them.
fn coefficients(outcome: &Outcome) -> String {
    let angle =
        |degrees: f64| if outcome.angles.radians { format!("{:.4}", degrees.to_radians()) } else { turned(degrees, 4) };
    let pair = |polar: &Polar| format!("[{:.6e}, {}]", polar.amplitude, angle(polar.degrees));
    let table = |plane: &Plane| {
        let pairs: Vec<String> = plane.coefficients.iter().map(pair).collect();
        format!("[[influence]]\nplane = {:?}\ncoefficients = [{}]\n", plane.plane, pairs.join(", "))
    };
    outcome.planes.iter().map(table).collect()
}

/// A weight as two at given angles.
fn split(weight: Complex<f64>, degrees: [f64; 2]) -> [Share; 2] {
    let [a, b] = degrees.map(|degrees| Complex::from_polar(1.0, degrees.to_radians()));
    let cross = |x: Complex<f64>, y: Complex<f64>| x.re * y.im - x.im * y.re;
    let share = |weight: f64, degrees: f64| Share { weight, degrees };
    [share(cross(weight, b) / cross(a, b), degrees[0]), share(cross(a, weight) / cross(a, b), degrees[1])]
}

/// The largest vibration that is left without a plane.
fn without(
    influence: &Influence<f64, ROWS, PLANES>,
    last: &[Complex<f64>],
    aim: &Aim<f64, ROWS, PLANES>,
    plane: usize,
) -> Option<f64> {
    let mut fewer = Influence::<f64, ROWS, PLANES>::new(influence.rows(), influence.planes() - 1).ok()?;
    let mut aim = *aim;
    for (place, other) in (0..influence.planes()).filter(|other| *other != plane).enumerate() {
        let column: Vec<_> = (0..influence.rows()).map(|row| influence.get(row, other)).collect::<Option<_>>()?;
        fewer.set(place, &column).ok()?;
        aim.limits[place] = aim.limits[other];
    }
    fewer.correct(last, &aim).ok().map(|correction| correction.largest)
}

fn outcome(file: &BalanceFile) -> Result<Outcome, Fault> {
    let Measured::Phasors { procedure, baseline, last, rpm, on, corrections, changes } = &file.measured else {
        return Err(Error::TooEarly.into());
    };
    let correction: Correction<f64, ROWS, PLANES> = procedure.correction()?;
    let influence = procedure.influence()?;
    let weight = |z: Complex<f64>| Polar::of(file.angles.weight(z));
    let reading = |z: Complex<f64>| Polar::of(file.angles.reading(z));
    let mut placed = correction.weights;
    let mut planes = Vec::new();
    for (plane, name) in file.planes.iter().enumerate() {
        let mut fitted = None;
        if let Some(holes) = file.holes.iter().find(|holes| holes.plane == plane) {
            let (sum, used) = fill(holes, file.angles.weight(correction.weights[plane]))?;
            placed[plane] = file.angles.weight(sum);
            fitted = Some(used);
        }
        let out = correction.left_out.iter().find(|out| out.plane == plane);
        planes.push(Plane {
            plane: name.clone(),
            weight: weight(correction.weights[plane]),
            total: weight(on[plane] + placed[plane]),
            split: (file.splits.iter().find(|(split, _)| *split == plane))
                .map(|(_, angles)| split(file.angles.weight(correction.weights[plane]), *angles)),
            largest_without: without(&influence, last, &procedure.plan().aim, plane),
            coefficients: (0..file.sensors.len()).filter_map(|row| influence.get(row, plane).map(reading)).collect(),
            change_by_trial: changes[plane],
            holes: fitted,
            left_out: out.map(|out| {
                let like: Vec<String> = (file.planes.iter().zip(&out.like))
                    .filter(|(_, weight)| weight.norm() > 1e-3)
                    .map(|(name, like)| {
                        let [amount, angle] = weight(*like).told();
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
    let expected = influence.predict(baseline, on)?;
    let largest = |run: &[Complex<f64>]| run.iter().map(|value| value.norm()).fold(0.0, f64::max);
    let apart = |run: &[Complex<f64>]| largest(&run.iter().zip(&expected).map(|(a, b)| a - b).collect::<Vec<_>>());
    let is_missed = *corrections > 0 && apart(last) > MISSED * apart(baseline);
    let missed = is_missed.then(|| [largest(last), largest(&expected)]);
    // rounding of the largest reading counts as zero
    let most = last.iter().map(|value| value.norm()).fold(0.0, f64::max);
    let left = |value: Complex<f64>| reading(if value.norm() < 1e-12 * most { Complex::new(0.0, 0.0) } else { value });
    let rows = (0..file.sensors.len())
        .map(|row| Row {
            sensor: file.sensors[row].clone(),
            rpm: rpm.get(row).copied(),
            counts: procedure.plan().aim.weighting[row] > 0.0,
            baseline: reading(baseline[row]),
            now: reading(last[row]),
            predicted: left(correction.residual[row]),
            predicted_with_holes: with_holes.map(|rows| left(rows[row])),
        })
        .collect();
    Ok(Outcome {
        name: file.name.clone(),
        unit: file.unit.clone(),
        weight_unit: file.weight_unit.name(),
        angles: file.angles,
        corrections: *corrections,
        condition: correction.condition,
        rows,
        planes,
        missed,
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
    let unit = if outcome.unit.is_empty() { String::new() } else { format!(" {}", outcome.unit) };
    format!("{what} the largest vibration goes from {} to {}{unit}.", significant(now), significant(after))
}

fn facts(outcome: &Outcome) -> Vec<Fact> {
    let mut facts = vec![fact("condition of the planes", significant(outcome.condition))];
    let slight = |plane: &Plane| plane.change_by_trial.filter(|change| *change < SLIGHT);
    facts.extend(outcome.planes.iter().filter_map(|plane| {
        let text = format!("changes the readings by {} only: take a heavier one to be sure", percent(slight(plane)?));
        Some(fact(format!("trial weight of {}", plane.plane), text))
    }));
    facts.extend(outcome.missed.map(|[found, expected]| {
        let text = format!(
            "{} where {} was predicted: amounts, places or angles of the weights on the rotor, or `phase_sense`, are \
             not as the file has them",
            significant(found),
            significant(expected)
        );
        fact("the corrections so far", text)
    }));
    facts.extend(outcome.grade.iter().flat_map(Grade::facts));
    facts
}

/// The tables as title, explanation and table: for the terminal and the page alike.
fn tables(outcome: &Outcome) -> Vec<Section> {
    let columns =
        ["plane", &format!("add {}", outcome.weight_unit), "at °", "in all", "at °", "largest without", "holes"];
    let mut weights = Table::new(columns);
    for plane in &outcome.planes {
        let halves = |shares: [Share; 2]| {
            shares.map(|share| format!("{} at {}°", significant(share.weight), significant(share.degrees))).join(", ")
        };
        let holes = plane.split.map_or_else(|| told(plane.holes.as_deref()), halves);
        let holes = plane.left_out.clone().unwrap_or(holes);
        let [amount, angle] = plane.weight.told();
        let [total, total_angle] = plane.total.told();
        let without = plane.largest_without.map_or_else(String::new, significant);
        weights.row([plane.plane.clone(), amount, angle, total, total_angle, without, holes]);
    }
    let mut rows = Table::new(["reading", "rpm", "baseline", "°", "now", "°", "predicted", "°", "with holes", "°"]);
    for row in &outcome.rows {
        let fitted = row.predicted_with_holes.map_or_else(|| [String::new(), String::new()], Polar::told);
        let polar = [row.baseline, row.now, row.predicted].into_iter().flat_map(Polar::told);
        let name = if row.counts { row.sensor.clone() } else { format!("{} (left out)", row.sensor) };
        rows.row([name, row.rpm.map_or_else(String::new, significant)].into_iter().chain(polar).chain(fitted));
    }
    let unit = if outcome.unit.is_empty() { String::new() } else { format!(" [{}]", outcome.unit) };
    vec![
        Section::new(
            "Weights",
            "To be added to the weights now on the rotor, and all with them; angles as those of the trial weights. \
             Beside it the largest vibration where the plane is left out.",
            weights,
        ),
        Section::new(format!("Vibration{unit}"), "As predicted from the influence of the trial weights.", rows),
    ]
}

fn page(outcome: &Outcome) -> Sheet {
    let [of_weights, of_phases] = outcome.angles.senses();
    let vibration = |row: &Row| {
        let mut arrows = vec![arrow("s5", "baseline", row.baseline), arrow("s1", "now", row.now)];
        arrows.push(arrow("s2", "predicted", row.predicted_with_holes.unwrap_or(row.predicted)));
        let rpm = row.rpm.map_or_else(String::new, |rpm| format!(", {} rpm", significant(rpm)));
        polar(&format!("{}{rpm}", row.sensor), &outcome.unit, of_phases, &arrows)
    };
    let weight = |plane: &Plane| {
        let arrows = arrows_of(plane.weight, plane.holes.as_deref());
        polar(&plane.plane, outcome.weight_unit, of_weights, &arrows)
    };
    Sheet {
        name: outcome.name.clone(),
        kicker: "balancing".to_owned(),
        summary: summary(outcome),
        facts: facts(outcome),
        figures: vec![
            Figure {
                title: "Polar plots of the weights".to_owned(),
                text: "Weight to add in each plane, and its split between holes.".to_owned(),
                legend: vec![Key::arrow("weight", "s0"), Key::arrow("in a hole", "s3")],
                plots: outcome.planes.iter().map(weight).collect(),
                arrangement: Arrangement::Beside,
            },
            Figure {
                title: "Polar plots of the vibration".to_owned(),
                text: "Amplitude and phase of each reading: at the beginning, now, and as predicted.".to_owned(),
                legend: vec![Key::arrow("baseline", "s5"), Key::arrow("now", "s1"), Key::arrow("predicted", "s2")],
                plots: outcome.rows.iter().map(vibration).collect(),
                arrangement: Arrangement::Beside,
            },
        ],
        tables: tables(outcome),
    }
}
