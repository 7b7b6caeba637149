//! Prerequisites beside Rust: found, and installed where permitted.
//!
//! Needed: the compiler's targets of the boards, `rustfmt` and `clippy`, QEMU for Arm, and `mdbook` for the check.
//! Rust's own parts come through `rustup`, QEMU through the system's package manager as root or through `sudo` without
//! a password. Nothing is ever removed: where `apt-get` would have to, or may not be used, QEMU is unpacked into the
//! user's cache. `mdbook` is compiled into that cache. A failed installation is an error with the command to type.

mod book;
mod packages;
mod private_copy;
mod programs;
mod runner;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use driveline_firmware::board::{BOARDS, FURTHER, Facts, RISC_V};

use crate::link::{Emulator, QEMU, QEMU_RISC_V};
pub use book::mdbook;
use packages::{Manager, Rights};
pub use programs::cargo;
use programs::succeeds;
use runner::Runner;

/// Something that is needed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Need {
    /// The compiler's standard library for a target.
    Target(&'static str),
    /// A component of the toolchain, and the subcommand of cargo that shows whether it is there.
    Component(&'static str, &'static str),
    /// QEMU for Arm.
    Qemu,
    /// `mdbook`, which builds the book.
    Book,
}

/// Something that is needed and could not be installed.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what} is missing and could not be installed ({reason}); type: {command}")]
pub struct SetupError {
    /// Missing parts.
    pub what: String,
    /// Why it was not installed.
    pub reason: String,
    /// Command to type.
    pub command: String,
}

impl Need {
    /// All that is needed: to build for every board, to run in QEMU, to check the source and the book.
    pub fn all() -> Vec<Need> {
        let mut all = Self::to_build(BOARDS.iter().chain(FURTHER));
        all.extend([Need::Component("rustfmt", "fmt"), Need::Component("clippy", "clippy"), Need::Qemu, Need::Book]);
        all
    }

    /// Prerequisites of building for some boards.
    pub fn to_build<'b>(boards: impl IntoIterator<Item = &'b Facts>) -> Vec<Need> {
        let targets: BTreeSet<_> = boards.into_iter().map(|board| board.target).collect();
        targets.into_iter().map(Need::Target).collect()
    }

    /// Prerequisites of building for some boards and running there in QEMU.
    pub fn to_run<'b>(boards: impl IntoIterator<Item = &'b Facts>) -> Vec<Need> {
        let mut needs = Self::to_build(boards);
        needs.push(Need::Qemu);
        needs
    }

    /// Whether it is there.
    pub fn is_met(&self) -> bool {
        match self {
            Need::Target(target) => has_target(target),
            Need::Component(_, subcommand) => succeeds(&cargo(), &[subcommand, "--version"]),
            Need::Qemu => Emulator::find().is_some_and(|emulator| emulator.answers()),
            Need::Book => book::answers(&mdbook()),
        }
    }

    pub fn name(&self) -> String {
        match self {
            Need::Target(target) => format!("the Rust target {target}"),
            Need::Component(name, _) => (*name).into(),
            Need::Qemu => QEMU.into(),
            Need::Book => "mdbook".into(),
        }
    }
}

/// Whether RISC-V images can be built and run here; nothing else needs that.
pub fn has_risc_v() -> bool {
    on_path(QEMU_RISC_V) && missing(&Need::to_build(RISC_V)).is_empty()
}

/// Missing prerequisites.
pub fn missing(needs: &[Need]) -> Vec<Need> {
    needs.iter().filter(|need| !need.is_met()).cloned().collect()
}

/// Installs what of some needs is missing, `progress` being given each command before it runs; the names of what was
/// installed.
pub fn ensure(needs: &[Need], mut progress: impl FnMut(&str)) -> Result<Vec<String>, SetupError> {
    let mut runner = Runner(&mut progress);
    missing(needs).into_iter().map(|need| install(&need, &mut runner).map(|()| need.name())).collect()
}

fn install(need: &Need, runner: &mut Runner) -> Result<(), SetupError> {
    match need {
        Need::Target(target) => rustup(need, &["rustup", "target", "add", target], runner),
        Need::Component(name, _) => rustup(need, &["rustup", "component", "add", name], runner),
        Need::Qemu => qemu(runner),
        Need::Book => book::install(runner).map_err(|reason| SetupError {
            what: need.name(),
            reason,
            command: book::command().join(" "),
        }),
    }?;
    let command = "cargo driveline setup".to_owned();
    let reason = "it was installed and is still not found".to_owned();
    if need.is_met() { Ok(()) } else { Err(SetupError { what: need.name(), reason, command }) }
}

/// A part of Rust, through `rustup`.
fn rustup(need: &Need, command: &[&str], runner: &mut Runner) -> Result<(), SetupError> {
    let line = command.join(" ");
    let failed = |reason: String, command: String| SetupError { what: need.name(), reason, command };
    if !on_path("rustup") {
        let reason = "`rustup` is not on the path, and Rust's own parts come through it".to_owned();
        let other = "or install the part with the package manager that Rust came with";
        return Err(failed(reason, format!("(install rustup as https://rustup.rs says, then) {line}, {other}")));
    }
    let words: Vec<String> = command.iter().map(|&word| word.into()).collect();
    runner.run(&words).map_err(|reason| failed(reason, line))
}

/// QEMU, through the package manager, else as a private copy.
fn qemu(runner: &mut Runner) -> Result<(), SetupError> {
    let what = || QEMU.to_owned();
    let Some(manager) = Manager::find(on_path) else {
        let reason = "no package manager known here: apt-get, dnf, pacman or brew".to_owned();
        return Err(SetupError { what: what(), reason, command: format!("(your system's way to install {QEMU})") });
    };
    let rights = Rights::find();
    let Err(reason) = installed(manager, rights, runner) else { return Ok(()) };
    let command = manager.install(rights).join(" ");
    if !private_copy::is_possible(manager) {
        return Err(SetupError { what: what(), reason, command });
    }
    runner.say(&format!("{reason}; {QEMU} is unpacked into {} instead", Emulator::folder().display()));
    let refused = |second| SetupError { what: what(), reason: format!("{reason}; {second}"), command };
    private_copy::make(runner).map_err(refused)
}

/// Installs QEMU for the whole system, if that needs no user and removes nothing; else a sentence.
fn installed(manager: Manager, rights: Rights, runner: &mut Runner) -> Result<(), String> {
    if !rights.suffice(manager) {
        return Err("installing needs root, and sudo is missing or needs a password".to_owned());
    }
    if let Some(update) = manager.update(rights)
        && let Err(error) = runner.run(&update)
    {
        // a source that does not answer need not be the one that has QEMU
        runner.say(&format!("{error}; the package lists stay as they are"));
    }
    let command = manager.install(rights);
    if manager == Manager::Apt {
        let trial = runner.trial(&manager.install(Rights::Root))?;
        if !trial.removed.is_empty() {
            return Err(format!("installing {QEMU} would remove {}", trial.removed.join(", ")));
        }
        runner.say(&trial.sentence());
    }
    runner.run(&command)
}

/// Whether the compiler has a standard library for a target; queries the compiler, so that it works without rustup.
fn has_target(target: &str) -> bool {
    let output = Command::new("rustc").args(["--print", "target-libdir", "--target", target]).output();
    output.is_ok_and(|output| {
        let directory = String::from_utf8_lossy(&output.stdout);
        output.status.success() && Path::new(directory.trim()).is_dir()
    })
}

/// Whether a program is on the search path.
fn on_path(program: &str) -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).map(|directory| directory.join(program)).any(|file: PathBuf| file.is_file())
}
