//! The command line of the laboratory: its own commands, and those of `cargo driveline`.

mod atlas;
mod check;
mod longest_path;
mod peers;
mod proof;
mod report;
mod run;

use std::ffi::OsString;
use std::process::ExitCode;

use cargo_driveline::cli::{CommandLine, Failure};
use clap::{Parser, Subcommand};

use crate::campaign::SCENES;

/// The firmware's scenes in closed loop with the full solver, studies, and the check of everything
#[derive(Debug, Parser)]
#[command(name = "cargo lab", bin_name = "cargo lab", version, max_term_width = 100)]
struct Lab {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Atlas(atlas::Atlas),
    Check(check::Check),
    LongestPath(longest_path::LongestPath),
    Peers(peers::Peers),
    Proof(proof::Proof),
    Report(report::Report),
    Run(run::Run),
    #[command(flatten)]
    Driveline(cargo_driveline::cli::Command),
}

impl CommandLine for Lab {
    fn json(&self) -> bool {
        match &self.command {
            Command::Atlas(_) => false,
            Command::Check(command) => command.json,
            Command::LongestPath(command) => command.json,
            Command::Peers(command) => command.json,
            Command::Proof(command) => command.json,
            Command::Report(command) => command.json,
            Command::Run(command) => command.json,
            Command::Driveline(command) => command.json(),
        }
    }

    fn execute(&self) -> Result<(), Failure> {
        match &self.command {
            Command::Atlas(command) => command.execute(),
            Command::Check(command) => command.execute(),
            Command::LongestPath(command) => command.execute(),
            Command::Peers(command) => command.execute(),
            Command::Proof(command) => command.execute(),
            Command::Report(command) => command.execute(),
            Command::Run(command) => command.execute(),
            Command::Driveline(cargo_driveline::cli::Command::Campaign(command)) => command.execute(SCENES),
            Command::Driveline(command) => command.execute(),
        }
    }
}

/// Runs a command line, the program's name first, and says how it ended.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    cargo_driveline::cli::run::<Lab>(&arguments)
}
