//! Everything that was measured.

use serde::Serialize;

use super::{Aim, Factor, Reason};
use crate::backlash::Comparison;
use crate::balancing;
use crate::cases::Case;
use crate::generator::verdict::Verdicts;
use crate::report::{Sweep, Variant};

/// A variant of a drivetrain.
#[derive(Clone, Debug, Serialize)]
pub struct Run {
    /// What it got wrong and what it costs.
    pub variant: Variant,
    /// Whether it is the design's choice, which is what the aims are for.
    pub chosen: bool,
    /// What the shaft carried.
    pub factor: Factor,
    /// Bytes of code that a tick reaches.
    pub tick_code: u64,
    /// Why it misses its aims; empty where it keeps them or is not the design's choice.
    pub reasons: Vec<Reason>,
}

/// A drivetrain in all its variants.
#[derive(Clone, Debug, Serialize)]
pub struct SceneFigures {
    /// Its name.
    pub name: String,
    /// What it is.
    pub summary: String,
    /// What is aimed at.
    pub aim: Aim,
    /// The variants that ran.
    pub runs: Vec<Run>,
}

impl SceneFigures {
    /// The variants of the design's choice.
    pub fn chosen(&self) -> impl Iterator<Item = &Run> {
        self.runs.iter().filter(|run| run.chosen)
    }

    /// The variants whose flash no other of the same number and core and rate is below.
    pub fn smallest(&self) -> Vec<&Run> {
        let like = |a: &Variant, b: &Variant| (&a.number, &a.core, a.rate_hz) == (&b.number, &b.core, b.rate_hz);
        let least = |run: &&Run| {
            let others = self.runs.iter().filter(|other| like(&other.variant, &run.variant));
            others.map(|other| other.variant.flash_bytes).min() == Some(run.variant.flash_bytes)
        };
        self.runs.iter().filter(least).collect()
    }

    /// The peak of a variant's shaft torque over that of the plain speed loop with the same number, core and rate, where
    /// the variant takes up slack; the plain loop's name beside it.
    ///
    /// Variants that take up slack are called so; all others are governed by a plain speed loop.
    pub fn over_plain(&self, run: &Run) -> Vec<(String, f64)> {
        let of = &run.variant;
        if of.observer != SLACK {
            return Vec::new();
        }
        let plain = self.runs.iter().filter(|other| {
            let other = &other.variant;
            other.observer != SLACK && (&other.number, &other.core, other.rate_hz) == (&of.number, &of.core, of.rate_hz)
        });
        plain.map(|other| (other.variant.observer.clone(), run.factor.peak / other.factor.peak)).collect()
    }
}

/// The name of variants that take up slack gently and damp the shaft.
const SLACK: &str = "slack";

/// What kept a job from being done.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Failure {
    /// The scene, or the part of the survey.
    pub place: String,
    /// What was being done.
    pub job: String,
    /// Why it was not.
    pub reason: String,
}

/// Everything.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Survey {
    /// The drivetrains.
    pub scenes: Vec<SceneFigures>,
    /// The generator sets, where they were asked for.
    pub generator: Option<Verdicts>,
    /// The rotors that were balanced, by scene.
    pub balanced: Vec<(String, Vec<balancing::Ran>)>,
    /// Published and made-up cases that are stiff or extreme.
    pub cases: Vec<Case>,
    /// Ways through backlash over random reversals.
    pub backlash: Option<Comparison>,
    /// The steps over stiff and extreme machines.
    pub sweeps: Vec<Sweep>,
    /// What could not be done.
    pub failures: Vec<Failure>,
    /// How long it all took [s].
    pub seconds: f64,
}

impl Survey {
    /// The failures in a place.
    pub fn failures_in(&self, place: &str) -> impl Iterator<Item = &Failure> {
        self.failures.iter().filter(move |failure| failure.place == place)
    }
}
