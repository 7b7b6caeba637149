//! `cargo lab check`: everything that must hold before a commit, and the long runs.

use clap::Args;
use clap::builder::PossibleValue;

use super::Failure;
use crate::check::{CheckError, LONG, Options, STEPS, run};
use driveline_qemu::clone::workspace;

/// Check everything: formatting, clippy, packages, the book, firmware, examples, tests, self-tests, the budgets.
///
/// Stops at the first step that fails, with the command to repeat it. With `--long` it runs all the long steps instead.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo lab check
  cargo lab check --only budgets --json
  cargo lab check --long --only power-cuts")]
pub struct Check {
    /// Only this step
    #[arg(long, value_name = "STEP", value_parser = names())]
    only: Option<String>,
    /// The long runs: minutes to hours each
    #[arg(long)]
    long: bool,
    /// Print one JSON object a step
    #[arg(long)]
    pub json: bool,
}

/// The steps with their contents, each name once.
fn names() -> Vec<PossibleValue> {
    let long = |name: &str| LONG.iter().find(|step| step.name == name);
    let steps = STEPS.iter().map(|step| match long(step.name) {
        Some(other) => (step.name, format!("{}; with --long: {}", step.content, other.content)),
        None => (step.name, step.content.to_owned()),
    });
    let others = LONG.iter().filter(|long| STEPS.iter().all(|step| step.name != long.name));
    let others = others.map(|step| (step.name, format!("with --long: {}", step.content)));
    steps.chain(others).map(|(name, content)| PossibleValue::new(name).help(content)).collect()
}

impl Check {
    /// Runs the steps.
    pub fn execute(&self) -> Result<(), Failure> {
        workspace().map_err(|error| Failure::usage(error.to_string()))?;
        match run(&Options { json: self.json, long: self.long, only: self.only.clone() }) {
            Ok(_) => Ok(()),
            Err(error @ CheckError::NoSuchStep(..)) => Err(Failure::usage(error.to_string())),
            Err(error) => Err(Failure::failed(error.to_string())),
        }
    }
}
