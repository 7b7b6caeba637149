//! `cargo driveline export`: a drive for firmware in another language, or for a simulation tool.

mod archive;
mod build;
mod core;
mod fmu;
mod interface;
mod library;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use serde_json::json;

use self::core::Core;
use self::fmu::Of;
use super::project::{Number, PartOptions, Project, is_free, name_of_c, write};
use super::results::{Destination, check_writable};
use super::setup::install;
use super::{Failure, say, say_json};
use crate::machine_file::{parse, slug, text};

/// Write a machine's drive as a static library for C and C++, or drive or machine as an FMU.
///
/// The library needs nothing of Rust: its state lies in the caller's memory, its constants in flash. It is compiled by
/// this computer's Rust; the firmware around it by any C compiler. An FMU is for co-simulation by FMI 3.0, on computers
/// of this one's kind.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo driveline export c hoist.toml --core m4f --out hoist-drive
  cargo driveline export c hoist.toml --core m3 --out hoist-drive --parts fluctuation
  cargo driveline export c my.toml --core host --out simulated --json
  cargo driveline export fmu hoist.toml --out hoist_controller.fmu
  cargo driveline export fmu hoist.toml --of plant --out hoist_plant.fmu")]
pub struct Export {
    /// What to write
    form: Form,
    /// The machine: a TOML file of elements from the motor to the load
    file: PathBuf,
    /// The core of the library
    #[arg(long, required_if_eq("form", "c"))]
    core: Option<Core>,
    /// What the FMU simulates [default: controller]
    #[arg(long)]
    of: Option<Of>,
    /// The folder to write, new or empty; of an FMU the file
    #[arg(long, value_name = "PATH")]
    out: PathBuf,
    /// Prefix of functions and types, the FMU's identifier; else the machine's name
    #[arg(long)]
    name: Option<String>,
    /// Number of the drive, not of a plant; else f32 on a core with an FPU and in an FMU, fixed on a core without
    #[arg(long)]
    number: Option<Number>,
    #[command(flatten)]
    parts: PartOptions,
    /// Print {folder, files, core, number, observer, state_bytes, undefined}; of an FMU {file, of, name, token}
    #[arg(long)]
    pub json: bool,
}

/// Forms that a drive is written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Form {
    /// A static library for C and C++
    C,
    /// An FMU for simulation tools
    Fmu,
}

/// The FMU of the drive of a machine in a file, in single precision.
///
/// # Errors
/// A file with a fault, a machine that no drive can be made of.
pub fn controller(file: &Path) -> Result<Vec<u8>, Failure> {
    let (place, source) = text(file, "a machine file")?;
    let machine = parse(&place, &source)?;
    let name = format!("{}-controller", slug(&machine.name));
    let project = Project::of(&machine, &name, Number::Single, &PartOptions::default())?.robust()?;
    name_of_c(&project.krate)?;
    Ok(fmu::fmu(&project, &source, Of::Controller)?.0)
}

impl Export {
    /// Compiles the library, then writes the folder or the FMU.
    ///
    /// # Errors
    /// A wrong name, a folder that is not empty, a machine that no drive can be made of. Nothing is left then.
    pub fn execute(&self) -> Result<(), Failure> {
        let (place, source) = text(&self.file, "a machine file")?;
        let machine = parse(&place, &source)?;
        self.options_fit()?;
        if self.form == Form::Fmu && self.of() == Of::Plant {
            fmu::is_a_plant(&machine, &source)?;
        }
        let core = self.core.unwrap_or(Core::Host);
        let number = self.number.unwrap_or(core.number());
        let usual = match self.form {
            Form::C => slug(&machine.name),
            Form::Fmu => format!("{}-{}", slug(&machine.name), self.of().name()),
        };
        let project = Project::of(&machine, self.name.as_deref().unwrap_or(&usual), number, &self.parts)?;
        name_of_c(&project.krate)?;
        match self.form {
            Form::C => self.library(&project.robust()?, &source, core, number),
            Form::Fmu if self.of() == Of::Controller => self.fmu(&project.robust()?, &source),
            Form::Fmu => self.fmu(&project, &source),
        }
    }

    fn options_fit(&self) -> Result<(), Failure> {
        match self.form {
            Form::C if self.of.is_some() => Err(Failure::usage("--of is for `fmu`: a library for C is the controller")),
            Form::Fmu
                if self.core.is_some() || !self.parts.parts.is_empty() || self.parts.vibration_limit.is_some() =>
            {
                let why = "an FMU is for this computer, without parts";
                Err(Failure::usage(format!("--core, --parts and --vibration-limit are for `c`: {why}")))
            }
            Form::Fmu if self.of() == Of::Plant && self.number.is_some() => {
                Err(Failure::usage("--number is for a controller: a plant is in double precision"))
            }
            _ => Ok(()),
        }
    }

    fn of(&self) -> Of {
        self.of.unwrap_or(Of::Controller)
    }

    fn library(&self, project: &Project, source: &str, core: Core, number: Number) -> Result<(), Failure> {
        is_free(&self.out)?;
        install(&core.needs())?;
        let library = library::library(project, source, core)?;
        write(&self.out, &library.files)?;
        if self.json {
            let names: Vec<&str> = library.files.iter().map(|(path, _)| path.as_str()).collect();
            return say_json(&json!({
                "folder": self.out, "files": names, "core": core.key(), "number": number.name(),
                "observer": project.observer(), "state_bytes": library.state, "undefined": library.undefined,
            }));
        }
        say(format_args!(
            "{} has lib{krate}.a and {krate}.h for a {}: {} with a speed loop in {}, {} bytes of state\n\
             README.md there says how to use them",
            self.out.display(),
            core.name(),
            project.observer(),
            number.name(),
            library.state,
            krate = project.krate,
        ));
        Ok(())
    }

    fn fmu(&self, project: &Project, source: &str) -> Result<(), Failure> {
        let file = Destination::chosen("FMU", &self.out);
        check_writable(&[&self.file], [&file])?;
        let (fmu, token) = fmu::fmu(project, source, self.of())?;
        file.write_and_say(&fmu, self.json)?;
        if self.json {
            let of = self.of().name();
            say_json(&json!({ "file": self.out, "of": of, "name": project.krate, "token": token }))?;
        }
        Ok(())
    }
}
