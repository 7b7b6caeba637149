//! The weight from amplitudes alone: one plane, no phases.

use std::fmt::Write as _;

use driveline::balancing::{Complex, FromAmplitudes};
use serde::Serialize;

use super::fault::Fault;
use super::grade::{Grade, grade};
use super::weight::{Hole, Polar, arrows_of, fill, told};
use crate::machine_file::balance::BalanceFile;
use driveline_report::chart::polar;
use driveline_report::format::{percent, significant};
use driveline_report::{Arrangement, Fact, Figure, Key, Section, Sheet, Table, fact};

/// Result.
#[derive(Clone, Debug, Serialize)]
pub struct Outcome {
    name: String,
    unit: String,
    weight_unit: &'static str,
    /// Sense in which the weights' angles run.
    #[serde(skip)]
    sense: &'static str,
    baseline: f64,
    /// One weight to add, or two of which one is right.
    weights: Vec<Polar>,
    /// How well three or more runs agree.
    disagreement: f64,
    /// Prediction for each of the weights, if it is the right one.
    answers: Vec<Answer>,
}

/// Prediction for a weight.
#[derive(Clone, Debug, Serialize)]
struct Answer {
    weight: Polar,
    #[serde(skip_serializing_if = "Option::is_none")]
    holes: Option<Vec<Hole>>,
    /// Amplitude with it, or with its holes.
    predicted: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    grade: Option<Grade>,
}

/// Fits the weights into the holes, and judges them.
pub fn outcome(file: &BalanceFile, baseline: f64, found: &FromAmplitudes<f64>) -> Result<Outcome, Fault> {
    let weights: Vec<Complex<f64>> = [Some(found.weight), found.or].into_iter().flatten().collect();
    let mut answers = Vec::new();
    for &weight in &weights {
        let (placed, holes) = match file.holes.first() {
            Some(holes) => fill(holes, weight).map(|(sum, used)| (sum, Some(used)))?,
            None => (weight, None),
        };
        answers.push(Answer {
            weight: Polar::of(weight),
            holes,
            // v0 + a w, where a = -v0/weight
            predicted: baseline * (1.0 - placed / weight).norm(),
            grade: grade(file, &[file.angles.weight(weight)], &[file.angles.weight(placed)])?,
        });
    }
    Ok(Outcome {
        name: file.name.clone(),
        unit: file.unit.clone(),
        weight_unit: file.weight_unit.name(),
        sense: file.angles.senses()[0],
        baseline,
        weights: weights.into_iter().map(Polar::of).collect(),
        disagreement: found.disagreement,
        answers,
    })
}

impl Outcome {
    fn summary(&self) -> String {
        let mut said = String::new();
        for (index, weight) in self.weights.iter().enumerate() {
            let [amount, angle] = weight.told();
            let _ = writeln!(said, "{}{amount} {} at {angle}°", ["add ", "or  "][index.min(1)], self.weight_unit);
        }
        said.push_str(&if self.weights.len() > 1 {
            "Two trial runs leave two answers: try one, or make a third run.".to_owned()
        } else {
            let contradiction = percent(self.disagreement);
            format!("The runs contradict each other by {contradiction} of the trial weight's effect.")
        });
        said
    }

    fn facts(&self) -> Vec<Fact> {
        let unit = &self.unit;
        let mut facts = vec![fact("baseline", format!("{} {unit}", significant(self.baseline)))];
        for (index, answer) in self.answers.iter().enumerate() {
            let which = if self.answers.len() > 1 { format!("answer {}: ", index + 1) } else { String::new() };
            facts.push(fact(format!("{which}predicted"), format!("{} {unit}", significant(answer.predicted))));
            if answer.holes.is_some() {
                facts.push(fact(format!("{which}holes"), told(answer.holes.as_deref())));
            }
            let grade = answer.grade.iter().flat_map(Grade::facts);
            facts.extend(grade.map(|Fact { name, value }| fact(format!("{which}{name}"), value)));
        }
        facts
    }

    /// All that is said on the terminal.
    pub fn said(&self) -> String {
        let facts = self.facts().into_iter().map(|fact| format!("\n{}: {}", fact.name, fact.value.trim_end()));
        self.summary() + &facts.collect::<String>()
    }

    /// The page.
    pub fn page(&self) -> Sheet {
        let mut table = Table::new(["answer", &format!("add {}", self.weight_unit), "at °", "holes"]);
        for (index, answer) in self.answers.iter().enumerate() {
            let [amount, angle] = answer.weight.told();
            table.row([(index + 1).to_string(), amount, angle, told(answer.holes.as_deref())]);
        }
        let plot = |(index, answer): (usize, &Answer)| {
            let arrows = arrows_of(answer.weight, answer.holes.as_deref());
            polar(&format!("answer {}", index + 1), self.weight_unit, self.sense, &arrows)
        };
        Sheet {
            name: self.name.clone(),
            kicker: "balancing".to_owned(),
            summary: self.summary(),
            facts: self.facts(),
            figures: vec![Figure {
                title: "Polar plots of the weights".to_owned(),
                text: "Weight to add, and its split between holes.".to_owned(),
                legend: vec![Key::arrow("weight", "s0"), Key::arrow("in a hole", "s3")],
                plots: self.answers.iter().enumerate().map(plot).collect(),
                arrangement: Arrangement::Beside,
            }],
            tables: vec![Section::new("Weights", "From amplitudes alone: angles as those of the trial weight.", table)],
        }
    }
}
