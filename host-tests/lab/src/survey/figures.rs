//! Everything that was measured.

use serde::Serialize;

use super::{Aim, Factor};
use crate::balancing;
use crate::cases::Case;
use crate::commissioning::Verdict;
use crate::generator::verdict::Verdicts;
use driveline_report::{Sample, Variant};

/// A variant of a drivetrain.
#[derive(Clone, Debug, Serialize)]
pub struct Run {
    /// Its errors and cost.
    pub variant: Variant,
    /// Whether it is the design's choice, which is what the aims are for.
    pub chosen: bool,
    /// Shaft torque, run by run.
    pub factors: Vec<Factor>,
}

impl Run {
    /// Of the run with the largest peak.
    pub fn factor(&self) -> Factor {
        self.factors.iter().max_by(|a, b| a.peak.total_cmp(&b.peak)).cloned().unwrap_or_default()
    }
}

/// Peak of a governor with backlash take-up against a plain speed loop's.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Gentle {
    /// The run.
    pub scenario: String,
    /// The variant with the plain loop.
    pub plain: String,
    /// Peak with backlash take-up over the plain one's.
    pub share: f64,
}

/// A drivetrain in all its variants.
#[derive(Clone, Debug, Serialize)]
pub struct SceneFigures {
    pub name: String,
    /// Its kind.
    pub summary: String,
    /// The requirement.
    pub aim: Aim,
    /// The variants that ran.
    pub runs: Vec<Run>,
}

impl SceneFigures {
    /// The variants of the design's choice.
    pub fn chosen(&self) -> impl Iterator<Item = &Run> {
        self.runs.iter().filter(|run| run.chosen)
    }

    /// Peaks of the shaft torque over those of the plain speed loop with the same number, core and rate, of a variant
    /// that takes up slack; of each run in which the plain loop lets a gap open or a rope go slack.
    ///
    /// Variants that take up slack are called so, and `learnt` where they learn beside it. The plain loop is the
    /// variant `plain`; where there is none, every other is governed by it.
    pub fn gentle(&self, run: &Run) -> Vec<Gentle> {
        let of = &run.variant;
        if of.observer != SLACK {
            return Vec::new();
        }
        let others = || {
            self.runs.iter().filter(|other| {
                let other = &other.variant;
                ![SLACK, LEARNT].contains(&other.observer.as_str())
                    && (&other.number, &other.core, other.rate_hz) == (&of.number, &of.core, of.rate_hz)
            })
        };
        let named = others().any(|other| other.variant.observer == PLAIN);
        let mut gentle = Vec::new();
        for other in others().filter(|other| !named || other.variant.observer == PLAIN) {
            for (own, rough) in run.factors.iter().zip(&other.factors).filter(|(_, rough)| rough.opened) {
                let (scenario, plain) = (own.scenario.clone(), other.variant.observer.clone());
                gentle.push(Gentle { scenario, plain, share: own.peak / rough.peak });
            }
        }
        gentle
    }
}

/// Name of the variants with backlash take-up and active damping.
const SLACK: &str = "slack";
/// Name of the variants that learn: where a scene has both, with backlash take-up too.
const LEARNT: &str = "learnt";
/// The name of variants with the same observer and a plain speed loop.
const PLAIN: &str = "plain";

/// Error of a job.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Failure {
    /// The scene, or the part of the survey.
    pub place: String,
    /// The step.
    pub job: String,
    /// Why it was not.
    pub reason: String,
}

/// Everything.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Survey {
    /// The drivetrains.
    pub scenes: Vec<SceneFigures>,
    /// The chosen drives on samples of machines within their tolerances.
    pub samples: Vec<Sample>,
    /// The gensets, where requested.
    pub generator: Option<Verdicts>,
    /// The machines that were commissioned, each beside its true figures.
    pub commissioned: Vec<Verdict>,
    /// The rotors that were balanced, by scene.
    pub balanced: Vec<(String, Vec<balancing::Ran>)>,
    /// Published and made-up cases that are stiff or extreme.
    pub cases: Vec<Case>,
    /// Failed jobs.
    pub failures: Vec<Failure>,
    /// How long it all took (s).
    pub seconds: f64,
    /// Day and commit.
    pub measured: String,
    /// Whether it was only tried out: two seconds of each drivetrain, unproven.
    pub quick: bool,
    /// Whether only some scenes were requested.
    pub part: bool,
}

impl Survey {
    pub fn failures_in(&self, place: &str) -> impl Iterator<Item = &Failure> {
        self.failures.iter().filter(move |failure| failure.place == place)
    }
}
