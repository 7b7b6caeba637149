//! `cargo driveline new`: a firmware crate of the user's own.

use std::path::{Path, PathBuf};
use std::{fs, io};

use clap::{Args, ValueEnum};
use serde::Serialize;
use serde_json::json;

use super::project::{Number, PartOptions, Project, fill, is_free, write};
use super::setup::install;
use super::{Failure, say, say_json};
use crate::machine_file::{parse, text};
use driveline_firmware::board::{Facts, mps2_an385, mps2_an386, nucleo_g474re};
use driveline_qemu::clone;
use driveline_qemu::setup::Need;

/// The machine where none is named.
const ROLL: &str = include_str!("../../machines/roll.toml");

/// Write a firmware crate of your own: a machine, its drive, a board, a test against the full solver.
///
/// `cargo run` in it starts the firmware in QEMU, `cargo test` runs it on the host. The folder must not exist, or be
/// empty, and lie outside a clone of driveline.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo driveline new ../roll && cd ../roll && cargo run
  cargo driveline new ../crane --machine hoist.toml --board qemu-m3
  cargo driveline new ../fan --board nucleo-g474re --parts fluctuation
  cargo driveline new . --update")]
pub struct New {
    /// The folder; its last part is the crate's name
    name: PathBuf,
    /// The machine: a TOML file of elements from the motor to the load; else a motor, a coupling and a roll
    #[arg(long, value_name = "FILE")]
    machine: Option<PathBuf>,
    /// The board
    #[arg(long, default_value = "qemu-m4f")]
    board: Board,
    #[command(flatten)]
    parts: PartOptions,
    /// Write anew what follows from machine.toml in a project of this command; a file that changes is kept as FILE.old
    #[arg(long, conflicts_with = "machine")]
    update: bool,
    /// Print {folder, files, board, number, observer}
    #[arg(long)]
    pub json: bool,
}

/// What follows from the machine in a project.
const DERIVED: [&str; 4] = ["src/lib.rs", "src/machine.rs", "src/simulated.rs", "tests/closed_loop.rs"];

/// A board that a project begins with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Board {
    /// Cortex-M4F in QEMU, in `f32`, with a simulated machine
    QemuM4f,
    /// Cortex-M3 in QEMU, in fixed point, with a simulated machine
    QemuM3,
    /// NUCLEO-G474RE, in `f32`
    NucleoG474re,
    /// Your own, with a Cortex-M4F
    Generic,
}

impl Board {
    const fn facts(self) -> Facts {
        match self {
            Board::QemuM4f | Board::Generic => mps2_an386::FACTS,
            Board::QemuM3 => mps2_an385::FACTS,
            Board::NucleoG474re => nucleo_g474re::FACTS,
        }
    }

    const fn number(self) -> Number {
        if matches!(self, Board::QemuM3) { Number::Fixed } else { Number::Single }
    }

    const fn is_in_qemu(self) -> bool {
        matches!(self, Board::QemuM3 | Board::QemuM4f)
    }

    /// The template of `src/board.rs`.
    const fn template(self) -> &'static str {
        match self {
            Board::QemuM3 | Board::QemuM4f => "new/qemu.rs",
            Board::NucleoG474re => "new/nucleo_g474re.rs",
            Board::Generic => "new/generic.rs",
        }
    }
}

/// Inputs of the templates.
#[derive(Serialize)]
struct Values {
    #[serde(flatten)]
    project: Project,
    /// To other languages or programs: none.
    interface: &'static str,
    board: String,
    board_name: &'static str,
    target: &'static str,
    /// QEMU's machine; empty for a board that it does not have.
    qemu: &'static str,
    tool: String,
    run: &'static str,
    /// Options of this command that write the project again.
    options: String,
}

impl New {
    /// The options that a project depends on beside its machine.
    fn options(&self) -> String {
        let name = |value: clap::builder::PossibleValue| value.get_name().to_owned();
        let board = self.board.to_possible_value().map(name).unwrap_or_default();
        let parts: Vec<String> =
            self.parts.parts.iter().filter_map(|part| part.to_possible_value().map(name)).collect();
        let parts = if parts.is_empty() { String::new() } else { format!(" --parts {}", parts.join(",")) };
        let limit = self.parts.vibration_limit.map_or_else(String::new, |limit| format!(" --vibration-limit {limit}"));
        format!("--board {board}{parts}{limit}")
    }

    /// Installs the compiler's target, then writes the folder.
    ///
    /// # Errors
    /// A wrong name, a folder that is not empty or lies in a clone, a machine that no drive can be made of. Nothing is
    /// left then. An update whose copies would be written over.
    pub fn execute(&self) -> Result<(), Failure> {
        let known = if self.update { Some(package(&self.name)?) } else { None };
        let of_folder = || self.name.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let name = known.as_deref().unwrap_or_else(of_folder);
        let (place, source) = match &self.machine {
            Some(file) => text(file, "a machine file")?,
            None if self.update => text(&self.name.join("machine.toml"), "a machine file")?,
            None => ("roll.toml".to_owned(), ROLL.to_owned()),
        };
        let machine = parse(&place, &source)?;
        let project = Project::of(&machine, name, self.board.number(), &self.parts)?.robust()?;
        if !self.update {
            is_free(&self.name)?;
            is_outside(&self.name)?;
        }
        let facts = self.board.facts();
        install(&Need::to_build([&facts]))?;
        let observer = project.observer().to_owned();
        let values = Values {
            project,
            interface: "",
            board: self.board.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default(),
            board_name: match self.board {
                Board::QemuM4f => "a Cortex-M4F in QEMU",
                Board::QemuM3 => "a Cortex-M3 in QEMU",
                Board::NucleoG474re => "a NUCLEO-G474RE",
                Board::Generic => "your board",
            },
            target: facts.target,
            qemu: if self.board.is_in_qemu() { facts.name } else { "" },
            tool: tool(),
            run: if self.board.is_in_qemu() {
                "builds the firmware and starts it in QEMU"
            } else {
                "flashes the board"
            },
            options: self.options(),
        };
        let files: Vec<(String, Vec<u8>)> = [
            ("Cargo.toml", "new/Cargo.toml"),
            (".cargo/config.toml", "new/config.toml"),
            ("README.md", "new/README.md"),
            ("build.rs", "new/build.rs"),
            ("memory.x", "new/memory.x"),
            ("src/board.rs", self.board.template()),
            ("src/firmware.rs", "new/firmware.rs"),
            ("src/lib.rs", "lib.rs"),
            ("src/machine.rs", "machine.rs"),
            ("src/main.rs", "new/main.rs"),
            ("src/simulated.rs", "new/simulated.rs"),
            ("tests/closed_loop.rs", "new/closed_loop.rs"),
        ]
        .map(|(path, template)| {
            let text = fill(template, &values);
            let text = if path == "src/machine.rs" { marked(&text, &source) } else { text };
            (path.to_owned(), text.into_bytes())
        })
        .into_iter()
        .chain([("machine.toml".to_owned(), source.into_bytes()), (".gitignore".to_owned(), b"/target\n".to_vec())])
        .collect();
        if self.update {
            let changed = update(&self.name, &files)?;
            if self.json {
                return say_json(&json!({ "folder": self.name, "changed": changed, "observer": observer }));
            }
            let kept = changed.iter().map(|path| format!("{path}, the former one as {path}.old"));
            let kept =
                if changed.is_empty() { "nothing has changed".to_owned() } else { kept.collect::<Vec<_>>().join("\n") };
            say(format_args!("{observer} with a speed loop\n{kept}"));
            return Ok(());
        }
        write(&self.name, &files)?;
        if self.json {
            let names: Vec<&str> = files.iter().map(|(path, _)| path.as_str()).collect();
            return say_json(&json!({
                "folder": self.name, "files": names, "board": values.board, "number": self.board.number().name(),
                "observer": observer,
            }));
        }
        say(format_args!(
            "{} has the drive of `{}` on {}: {observer} with a speed loop\n\
             cd {}, then cargo run, cargo test (minutes, the first time)",
            self.name.display(),
            machine.name,
            values.board_name,
            self.name.display(),
        ));
        Ok(())
    }
}

/// The name of a project's package.
fn package(folder: &Path) -> Result<String, Failure> {
    let file = folder.join("Cargo.toml");
    let text = fs::read_to_string(&file).unwrap_or_default();
    let name = text.lines().find_map(|line| line.strip_prefix("name = \"")?.strip_suffix('"'));
    name.map(str::to_owned).ok_or_else(|| {
        let file = file.display();
        Failure::usage(format!("{file} names no package: --update is for the folder of a project of `new`"))
    })
}

/// Mark of a text but for spaces and commas, which a formatter sets: FNV-1a in 64 bits, as `build.rs` has it.
fn mark(text: &str) -> u64 {
    let bytes = text.bytes().filter(|byte| !byte.is_ascii_whitespace() && *byte != b',');
    bytes.fold(0xcbf2_9ce4_8422_2325, |mark, byte| (mark ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// The machine's constants with the marks of `machine.toml` and of what was made of it.
fn marked(text: &str, source: &str) -> String {
    let made = text.find("impl Machine").map_or(text, |at| &text[at..]);
    let marks = format!("//! Marks for `build.rs`: {:016x} {:016x}", mark(source), mark(made));
    text.replacen("\n\n", &format!("\n//!\n{marks}\n\n"), 1)
}

/// Writes what follows from the machine where it differs, and keeps what was there.
fn update(folder: &Path, files: &[(String, Vec<u8>)]) -> Result<Vec<String>, Failure> {
    let derived = files.iter().filter(|(path, _)| DERIVED.contains(&path.as_str()));
    let changed: Vec<_> =
        derived.filter(|(path, bytes)| fs::read(folder.join(path)).is_ok_and(|old| old != *bytes)).collect();
    let old = |path: &str| folder.join(format!("{path}.old"));
    if let Some((path, _)) = changed.iter().find(|(path, _)| old(path).exists()) {
        let old = old(path);
        return Err(Failure::usage(format!("{} would be written over; move or remove it", old.display())));
    }
    for (path, bytes) in &changed {
        let file = folder.join(path);
        let failed = |error: io::Error| Failure::failed(format!("{} cannot be written: {error}", file.display()));
        // a copy, so that a file is there whatever happens
        fs::copy(&file, old(path)).map_err(failed)?;
        fs::write(&file, bytes).map_err(failed)?;
    }
    Ok(changed.into_iter().map(|(path, _)| path.clone()).collect())
}

/// Whether a folder lies outside every clone of driveline: cargo takes the settings of all folders above a project, and
/// those of a clone contradict the project's own.
fn is_outside(folder: &Path) -> Result<(), Failure> {
    let whole = std::path::absolute(folder).unwrap_or_else(|_| folder.into());
    let parent = whole.parent().and_then(|parent| parent.canonicalize().ok()).unwrap_or_default();
    match (clone::root(&parent), folder.file_name()) {
        (Some(root), Some(name)) => Err(Failure::usage(format!(
            "{} would lie in the clone of driveline at {}, whose cargo settings would stop the project; name a folder \
             outside, such as ../{}",
            folder.display(),
            root.display(),
            Path::new(name).display(),
        ))),
        _ => Ok(()),
    }
}

/// This program, by its name where that finds it.
fn tool() -> String {
    const NAME: &str = "cargo-driveline";
    let this = std::env::current_exe().unwrap_or_else(|_| NAME.into());
    let path = std::env::var_os("PATH").unwrap_or_default();
    let found = std::env::split_paths(&path).map(|folder| folder.join(NAME)).find(|file| file.is_file());
    let is_this = found
        .and_then(|file| file.canonicalize().ok())
        .is_some_and(|file| this.canonicalize().is_ok_and(|this| this == file));
    if is_this { NAME.into() } else { this.to_string_lossy().replace('\\', "\\\\").replace('"', "\\\"") }
}
