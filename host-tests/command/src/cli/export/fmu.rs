//! The FMU: a crate for the functions of FMI 3.0, compiled, and packed with its description.

use std::env::consts::{ARCH, DLL_PREFIX, DLL_SUFFIX, OS};
use std::io::{Cursor, Write};

use clap::ValueEnum;
use serde::Serialize;
use toml::de::DeTable;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::build::build;
use super::interface::{Fault, faults};
use crate::cli::Failure;
use crate::cli::project::{Project, Source, fill};
use crate::machine_file::{DamperKind, MachineFile};

/// Simulated part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Of {
    /// The drive
    Controller,
    /// The machine, by the full solver
    Plant,
}

impl Of {
    /// Its name, as `--of` has it.
    pub const fn name(self) -> &'static str {
        match self {
            Of::Controller => "controller",
            Of::Plant => "plant",
        }
    }
}

/// Tables of a machine file that change its motion and that the plant does not have.
const NOT_OF_THE_PLANT: [&str; 4] = ["engine", "link", "torque", "friction"];

/// Whether a plant has all that moves the machine of a file with this text.
///
/// # Errors
/// The part that it does not have.
pub fn is_a_plant(machine: &MachineFile, source: &str) -> Result<(), Failure> {
    let no_plant = |why: String| Err(Failure::usage(format!("`{}`: no plant can be made: {why}", machine.name)));
    let refused = |part: String| no_plant(format!("{part}; leave it out of a copy of the file"));
    if machine.chain.shafts().is_empty() {
        return no_plant("it has no shaft; the plant has at least one between motor and load".into());
    }
    if !machine.branches.is_empty() {
        return refused("it has branches, and the plant is a chain".into());
    }
    let tables = DeTable::parse(source).map(|table| table.into_inner()).unwrap_or_default();
    if let Some(table) = NOT_OF_THE_PLANT.iter().find(|table| tables.contains_key(**table)) {
        return refused(format!("it has `{table}`, which the plant does not have"));
    }
    if machine.dampers.iter().any(|ring| matches!(ring.kind, DamperKind::Friction { .. })) {
        return refused("it has a damper of the kind `friction`, and the plant's masses have shafts only".to_owned());
    }
    if machine.viscous().iter().any(|viscous| *viscous > 0.0) {
        return refused("it has `viscous`, which the plant does not have".to_owned());
    }
    if let Some(why) = machine.gear_that_stops_at_once() {
        return no_plant(why);
    }
    match machine.losses_of_no_chain() {
        Some(label) => refused(format!("the losses of `{label}` need a shaft before or behind it")),
        None => Ok(()),
    }
}

/// Inputs of the templates.
#[derive(Serialize)]
struct Values<'p> {
    #[serde(flatten)]
    project: &'p Project,
    interface: &'static str,
    of: Of,
    faults: Vec<Fault>,
    period: String,
    version: &'static str,
    /// Empty in the crate, which is compiled before it is known.
    token: String,
}

/// The FMU and its instantiation token, of a machine whose file has this text.
///
/// # Errors
/// The compiler's error.
pub fn fmu(project: &Project, source: &str, of: Of) -> Result<(Vec<u8>, String), Failure> {
    let mut values = Values {
        project,
        interface: "fmi",
        of,
        faults: faults(),
        period: format!("{:?}", 1.0 / f64::from(project.rate_hz)),
        version: env!("CARGO_PKG_VERSION"),
        token: String::new(),
    };
    let templates: &[(&str, &str)] = match of {
        Of::Controller => {
            &[("src/lib.rs", "lib.rs"), ("src/machine.rs", "machine.rs"), ("src/model.rs", "fmu/controller.rs")]
        }
        Of::Plant => &[("src/model.rs", "fmu/plant.rs")],
    };
    let shared = [("Cargo.toml", "c/Cargo.toml"), ("src/fmi.rs", "fmu/fmi.rs")];
    let written = |(path, template): &(&str, &str)| (format!("rust/{path}"), fill(template, &values).into_bytes());
    let mut files: Vec<(String, Vec<u8>)> = shared.iter().chain(templates).map(written).collect();
    if of == Of::Plant {
        files.push(("rust/src/lib.rs".into(), b"mod fmi;\nmod model;\n".into()));
        files.extend(Source::find().lock().map(|lock| ("rust/Cargo.lock".into(), lock)));
    }
    let krate = &project.krate;
    let mut library = build(&files, None, &format!("{DLL_PREFIX}{krate}{DLL_SUFFIX}"), true)?;
    values.token = put_token(&mut library).map_err(Failure::failed)?;
    let description = fill("fmu/modelDescription.xml", &values);
    let platform = format!("{ARCH}-{}", if OS == "macos" { "darwin" } else { OS });
    let members = [
        ("modelDescription.xml".to_owned(), description.as_bytes()),
        (format!("binaries/{platform}/{krate}{DLL_SUFFIX}"), &library),
        ("resources/machine.toml".to_owned(), source.as_bytes()),
    ];
    let packed = packed(&members).map_err(|error| Failure::failed(format!("the FMU cannot be packed: {error}")))?;
    Ok((packed, values.token))
}

/// Placeholder of the token in a library that has just been compiled.
const PLACE: &[u8; 32] = b"DRIVELINE-INSTANTIATION-TOKEN---";

/// Puts the token in its place: a hash of the library (FNV-1a, 128 bit), since a saved state is good for no other.
fn put_token(library: &mut [u8]) -> Result<String, &'static str> {
    let step = |hash: u128, byte: &u8| (hash ^ u128::from(*byte)).wrapping_mul((1 << 88) + 0x13b);
    let hash = library.iter().fold(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d, step);
    let token = format!("{hash:032x}");
    let places = library.windows(PLACE.len()).filter(|bytes| bytes == PLACE).count();
    let place = library.windows(PLACE.len()).position(|bytes| bytes == PLACE).filter(|_| places == 1);
    let place = place.ok_or("the compiled library has not one place for the token")?;
    library[place..place + PLACE.len()].copy_from_slice(token.as_bytes());
    Ok(token)
}

/// A zip archive without compression and without the time of day.
fn packed(members: &[(String, &[u8])]) -> zip::result::ZipResult<Vec<u8>> {
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Stored).unix_permissions(0o755);
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for (path, bytes) in members {
        archive.start_file(path, options)?;
        archive.write_all(bytes)?;
    }
    Ok(archive.finish()?.into_inner())
}
