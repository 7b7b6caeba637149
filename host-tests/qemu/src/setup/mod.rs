//! What a machine needs beside Rust: found, and installed where that is permitted.
//!
//! Needed: the compiler's targets of the boards, `rustfmt` and `clippy`, and QEMU for Arm. Rust's own parts come through `rustup`, QEMU through
//! the system's package manager as root or through `sudo` where it asks for no password. What cannot be installed is an
//! error with the command to type.

mod packages;

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use driveline_firmware::board::{BOARDS, FURTHER};

use crate::link::QEMU;
use packages::{Manager, Rights};

/// Something that is needed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Need {
    /// The compiler's standard library for a target.
    Target(&'static str),
    /// A component of the toolchain, and the subcommand of cargo that shows whether it is there.
    Component(&'static str, &'static str),
    /// QEMU for Arm.
    Qemu,
}

/// Something that is needed and could not be installed.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what} is missing and could not be installed ({reason}); type: {command}")]
pub struct SetupError {
    /// What is missing.
    pub what: String,
    /// Why it was not installed.
    pub reason: String,
    /// What to type.
    pub command: String,
}

impl Need {
    /// All that is needed.
    pub fn all() -> Vec<Need> {
        let targets: BTreeSet<_> = BOARDS.iter().chain(FURTHER).map(|board| board.target).collect();
        let targets = targets.into_iter().map(Need::Target);
        targets.chain([Need::Component("rustfmt", "fmt"), Need::Component("clippy", "clippy"), Need::Qemu]).collect()
    }

    /// Whether it is there.
    pub fn is_met(&self) -> bool {
        match self {
            Need::Target(target) => has_target(target),
            Need::Component(_, subcommand) => succeeds(&cargo(), &[subcommand, "--version"]),
            Need::Qemu => succeeds(OsStr::new(QEMU), &["--version"]),
        }
    }

    /// What it is called.
    pub fn name(&self) -> String {
        match self {
            Need::Target(target) => format!("the Rust target {target}"),
            Need::Component(name, _) => (*name).into(),
            Need::Qemu => QEMU.into(),
        }
    }

    /// The commands that install it, each with its arguments.
    fn commands(&self, manager: Option<Manager>, rights: Rights) -> Vec<Vec<String>> {
        let words = |line: &str| line.split(' ').map(String::from).collect();
        match self {
            Need::Target(target) => vec![words(&format!("rustup target add {target}"))],
            Need::Component(name, _) => vec![words(&format!("rustup component add {name}"))],
            Need::Qemu => manager.map_or_else(Vec::new, |manager| manager.install_qemu(rights)),
        }
    }
}

/// What is missing of all that is needed.
pub fn missing() -> Vec<Need> {
    Need::all().into_iter().filter(|need| !need.is_met()).collect()
}

/// Installs what is missing, telling `progress` each command before it runs; the names of what was installed.
pub fn ensure(mut progress: impl FnMut(&str)) -> Result<Vec<String>, SetupError> {
    missing().into_iter().map(|need| install(&need, &mut progress).map(|()| need.name())).collect()
}

fn install(need: &Need, progress: &mut impl FnMut(&str)) -> Result<(), SetupError> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let manager = Manager::find(|program| find(program, &path).is_some());
    let rights = Rights::find();
    let commands = need.commands(manager, rights);
    let lines: Vec<_> = commands.iter().map(|command| command.join(" ")).collect();
    let failed = |reason: String| SetupError {
        what: need.name(),
        reason,
        command: if lines.is_empty() {
            format!("(your system's way to install {})", need.name())
        } else {
            lines.join(" && ")
        },
    };
    if commands.is_empty() {
        return Err(failed("no package manager known here: apt-get, dnf, pacman or brew".into()));
    }
    if *need == Need::Qemu && !rights.suffice(manager) {
        return Err(failed("that takes root, and sudo asks for a password or is not there".into()));
    }
    for (command, line) in commands.iter().zip(&lines) {
        progress(line);
        let (program, arguments) = command.split_first().ok_or_else(|| failed("no command".into()))?;
        let status = Command::new(program)
            .args(arguments)
            .env("DEBIAN_FRONTEND", "noninteractive")
            .stdin(Stdio::null())
            // standard output is for the check's own lines
            .stdout(std::io::stderr())
            .status()
            .map_err(|error| failed(format!("`{line}`: {error}")))?;
        if !status.success() {
            return Err(failed(format!("`{line}` ended with {status}")));
        }
    }
    if need.is_met() { Ok(()) } else { Err(failed("it was installed and is still not found".into())) }
}

/// The cargo that runs this program, else the one on the path.
pub fn cargo() -> std::ffi::OsString {
    std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into())
}

/// Whether the compiler has a standard library for a target; asks the compiler, so that it works without rustup.
fn has_target(target: &str) -> bool {
    let output = Command::new("rustc").args(["--print", "target-libdir", "--target", target]).output();
    output.is_ok_and(|output| {
        let directory = String::from_utf8_lossy(&output.stdout);
        output.status.success() && Path::new(directory.trim()).is_dir()
    })
}

fn succeeds(program: &OsStr, arguments: &[&str]) -> bool {
    let status = Command::new(program).args(arguments).stdout(Stdio::null()).stderr(Stdio::null()).status();
    status.is_ok_and(|status| status.success())
}

/// The program on a search path.
fn find(program: &str, path: &OsStr) -> Option<PathBuf> {
    std::env::split_paths(path).map(|directory| directory.join(program)).find(|file| file.is_file())
}
