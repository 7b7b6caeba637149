//! `cargo driveline check`: everything that must hold before a commit.

use clap::Args;

use super::Failure;
use crate::check::{CheckError, Options, STEPS, run};
use driveline_qemu::clone::workspace;

/// Check everything: formatting, clippy, packages, the book, firmware, examples, tests, self-tests, the budgets.
///
/// Stops at the first step that fails, with the command to repeat it.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  cargo driveline check\n  cargo driveline check --only budgets --json")]
pub struct Check {
    /// Only this step
    #[arg(long, value_name = "STEP", value_parser = STEPS.map(|step| step.name))]
    only: Option<String>,
    /// Print one JSON object a step
    #[arg(long)]
    pub json: bool,
}

impl Check {
    /// Runs the steps.
    ///
    /// # Errors
    /// The step that failed.
    pub fn execute(&self) -> Result<(), Failure> {
        workspace().map_err(|error| Failure::usage(error.to_string()))?;
        match run(&Options { json: self.json, only: self.only.clone() }) {
            Ok(_) => Ok(()),
            Err(error @ CheckError::NoSuchStep(_)) => Err(Failure::usage(error.to_string())),
            Err(error) => Err(Failure::failed(error.to_string())),
        }
    }
}
