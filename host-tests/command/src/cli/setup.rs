//! `cargo driveline setup`: what is missing is installed where that is permitted.

use clap::Args;
use serde_json::json;

use super::{Failure, say, say_json};
use driveline_qemu::clone::workspace;
use driveline_qemu::setup::{Need, ensure, missing};

/// Install what is missing: Rust targets, rustfmt, clippy, QEMU for Arm, mdbook.
///
/// Uses rustup and the system's package manager where it may; otherwise the exact command to type is printed. The other
/// commands install what they need by themselves. Nothing is ever removed.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  cargo driveline setup\n  cargo driveline setup --dry-run --json")]
pub struct Setup {
    /// Only say what is missing
    #[arg(long)]
    dry_run: bool,
    /// Print {missing, installed}
    #[arg(long)]
    pub json: bool,
}

/// For what builds from the repository: finds the clone and installs what of some needs is missing.
///
/// # Errors
/// The current folder is in no clone; what could not be installed.
pub fn ready(needs: &[Need]) -> Result<(), Failure> {
    workspace().map_err(|error| Failure::usage(error.to_string()))?;
    install(needs).map(drop)
}

/// Installs what of some needs is missing, with each command on standard error; the names of what was installed.
pub fn install(needs: &[Need]) -> Result<Vec<String>, Failure> {
    ensure(needs, |command| eprintln!("{command}")).map_err(|error| Failure::failed(error.to_string()))
}

impl Setup {
    /// Installs what is missing.
    ///
    /// # Errors
    /// What is missing and cannot be installed, with the command to type.
    pub fn execute(&self) -> Result<(), Failure> {
        let needs = Need::all();
        let lacking: Vec<String> = missing(&needs).iter().map(|need| need.name()).collect();
        let installed = if self.dry_run { Vec::new() } else { install(&needs)? };
        if self.json {
            return say_json(&json!({ "missing": lacking, "installed": installed }));
        }
        say(match (lacking.is_empty(), self.dry_run) {
            (true, _) => "nothing is missing".to_owned(),
            (false, true) => format!("missing: {}", lacking.join(", ")),
            (false, false) => format!("installed: {}", installed.join(", ")),
        });
        Ok(())
    }
}
