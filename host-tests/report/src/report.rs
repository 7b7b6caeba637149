//! The report of a run, whole.

use crate::results::{Budget, Fact, Variant};
use crate::sample::Sample;
use crate::trajectory::Trajectory;

/// Everything that a run has to say.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// The scene's name: `hoist`.
    pub scene: String,
    /// What was run, in a sentence or two.
    pub summary: String,
    /// What the machine and the run are.
    pub facts: Vec<Fact>,
    /// Drives on samples of machines within their tolerances.
    pub samples: Vec<Sample>,
    /// Every variant, in the order of the table.
    pub variants: Vec<Variant>,
    /// Courses over time; the first variant and situation are shown first.
    pub trajectories: Vec<Trajectory>,
    /// Budgets and what was measured against them.
    pub budgets: Vec<Budget>,
    /// What the reader should know, a sentence each.
    pub notes: Vec<String>,
}
