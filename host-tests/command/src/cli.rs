//! The command line: `cargo driveline run`, `modes`, `design`, `rotor`, `check`, `setup`.
//! The command line: `cargo driveline run`, `modes`, `simulate`, `design`, `check`, `setup`.
//! The command line: `cargo driveline run`, `modes`, `design`, `balance`, `check`, `setup`.
//! The command line: `cargo driveline run`, `modes`, `design`, `generator`, `check`, `setup`.
//! The command line: `cargo driveline run`, `modes`, `design`, `check`, `setup`, `watch`.
//!
//! | exit code | meaning |
//! |---|---|
//! | 0 | done |
//! | 1 | done, and the answer is no: a check failed, a run could not finish |
//! | 2 | not begun: a wrong argument or a machine file with a fault |
//!
//! Results go to standard output, progress and errors to standard error; an error is a sentence, with `--json` the
//! object
//! `{"error": ...}`.

mod backlash;
mod balance;
mod balancing;
mod check;
mod commission;
mod controller;
mod design;
mod emit;
mod failure;
mod generator;
mod modes;
mod output;
mod progress;
mod report;
mod rotor;
mod run;
mod setup;
mod simulate;
mod sizes;
mod watch;

pub use controller::Plan;
pub use emit::rust;
pub use failure::Failure;
pub use modes::Vibration;
pub use progress::Progress;

use std::ffi::OsString;
use std::process::ExitCode;
use std::sync::atomic::Ordering;

use clap::{Parser, Subcommand};
use output::{UNSAID, onto_itself, say, say_json};

/// Controllers for machine drives, checked against a full solver of the machine.
#[derive(Debug, Parser)]
#[command(name = "cargo driveline", bin_name = "cargo driveline", version, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Run(run::Run),
    Report(report::Report),
    Backlash(backlash::Backlash),
    Modes(modes::Modes),
    Design(design::Design),
    Rotor(rotor::Rotor),
    Balance(balance::Balance),
    Generator(generator::Generator),
    Check(check::Check),
    Commission(commission::Commission),
    Setup(setup::Setup),
    Simulate(simulate::Simulate),
    Sizes(sizes::Sizes),
    Watch(watch::Watch),
}

impl Command {
    const fn json(&self) -> bool {
        match self {
            Self::Run(command) => command.json,
            Self::Report(command) => command.json,
            Self::Backlash(command) => command.json,
            Self::Modes(command) => command.json,
            Self::Design(command) => command.json,
            Self::Rotor(command) => command.json,
            Self::Balance(command) => command.json,
            Self::Generator(command) => command.json,
            Self::Check(command) => command.json,
            Self::Commission(command) => command.json,
            Self::Setup(command) => command.json,
            Self::Simulate(command) => command.json,
            Self::Sizes(command) => command.json,
            Self::Watch(command) => command.json,
        }
    }

    fn execute(&self) -> Result<(), Failure> {
        match self {
            Self::Run(command) => command.execute(),
            Self::Report(command) => command.execute(),
            Self::Backlash(command) => command.execute(),
            Self::Modes(command) => command.execute(),
            Self::Design(command) => command.execute(),
            Self::Rotor(command) => command.execute(),
            Self::Balance(command) => command.execute(),
            Self::Generator(command) => command.execute(),
            Self::Check(command) => command.execute(),
            Self::Commission(command) => command.execute(),
            Self::Setup(command) => command.execute(),
            Self::Simulate(command) => command.execute(),
            Self::Sizes(command) => command.execute(),
            Self::Watch(command) => command.execute(),
        }
    }
}

/// Runs a command line, the program's name first, and says how it ended.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let mut arguments: Vec<OsString> = arguments.into_iter().collect();
    // Cargo runs `cargo-driveline driveline ...` for `cargo driveline ...`.
    if arguments.get(1).is_some_and(|first| first == "driveline") {
        arguments.remove(1);
    }
    let cli = match Cli::try_parse_from(&arguments) {
        Ok(cli) => cli,
        // Help and version come this way too, and are no errors.
        Err(error) if error.use_stderr() && arguments.iter().any(|argument| argument == "--json") => {
            let message = error.to_string();
            let sentence = message.lines().next().unwrap_or("wrong arguments").trim_start_matches("error: ");
            return Failure::usage(sentence).report(true);
        }
        Err(error) => error.exit(),
    };
    match cli.command.execute() {
        Ok(()) if UNSAID.load(Ordering::Relaxed) => Failure::failed("standard output cannot be written").report(false),
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(cli.command.json()),
    }
}
