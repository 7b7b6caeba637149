//! `cargo driveline export`: a drive for firmware in another language.

mod archive;
mod core;
mod interface;
mod library;

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use serde_json::json;

use self::core::Core;
use super::project::{Number, PartOptions, Project, is_free, name_of_c, write};
use super::setup::install;
use super::{Failure, say, say_json};
use crate::machine_file::{parse, text};

/// Write a machine's drive as a static library for C and C++, with its header and an example.
///
/// The library needs nothing of Rust: its state lies in the caller's memory, its constants in flash. It is compiled by
/// this computer's Rust; the firmware around it by any C compiler.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo driveline export c hoist.toml --core m4f --out hoist-drive
  cargo driveline export c hoist.toml --core m3 --out hoist-drive --parts fluctuation
  cargo driveline export c my.toml --core host --out simulated --json")]
pub struct Export {
    /// The language
    language: Language,
    /// The machine: a TOML file of elements from the motor to the load
    file: PathBuf,
    /// The core
    #[arg(long)]
    core: Core,
    /// The folder to write, new or empty
    #[arg(long, value_name = "FOLDER")]
    out: PathBuf,
    /// Prefix of functions and types; else the machine's name
    #[arg(long)]
    name: Option<String>,
    /// Number of the drive; else f32 on a core with an FPU, fixed on one without
    #[arg(long)]
    number: Option<NumberName>,
    #[command(flatten)]
    parts: PartOptions,
    /// Print {folder, files, core, number, observer, state_bytes, undefined}
    #[arg(long)]
    pub json: bool,
}

/// Languages that a drive is written for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Language {
    /// A static library for C and C++
    C,
}

/// The number of a drive, as an option names it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum NumberName {
    /// Single precision, in SI units
    F32,
    /// Fixed point, per unit of the machine's bases
    Fixed,
}

impl Export {
    /// Compiles the library, then writes the folder.
    ///
    /// # Errors
    /// A wrong name, a folder that is not empty, a machine that no drive can be made of. Nothing is left then.
    pub fn execute(&self) -> Result<(), Failure> {
        let Language::C = self.language;
        let (place, source) = text(&self.file, "a machine file")?;
        let machine = parse(&place, &source)?;
        let number = match self.number {
            None => self.core.number(),
            Some(NumberName::F32) => Number::Single,
            Some(NumberName::Fixed) => Number::Fixed,
        };
        let slug = machine.slug();
        let project = Project::of(&machine, self.name.as_deref().unwrap_or(&slug), number, &self.parts)?;
        name_of_c(&project.krate)?;
        is_free(&self.out)?;
        install(&self.core.needs())?;
        let library = library::library(&project, &source, self.core)?;
        write(&self.out, &library.files)?;
        if self.json {
            let names: Vec<&str> = library.files.iter().map(|(path, _)| path.as_str()).collect();
            return say_json(&json!({
                "folder": self.out, "files": names, "core": self.core.key(), "number": number.name(),
                "observer": project.observer(), "state_bytes": library.state, "undefined": library.undefined,
            }));
        }
        say(format_args!(
            "{} has lib{krate}.a and {krate}.h for a {}: {} with a speed loop in {}, {} bytes of state\n\
             README.md there says how to use them",
            self.out.display(),
            self.core.name(),
            project.observer(),
            number.name(),
            library.state,
            krate = project.krate,
        ));
        Ok(())
    }
}
