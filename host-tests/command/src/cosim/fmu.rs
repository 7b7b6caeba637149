//! An FMU: a file, unpacked, with its description and an instance.

use std::env::consts::{ARCH, DLL_SUFFIX, OS};
use std::fs::File;
use std::io::{Read, Seek};
use std::path::Path;

use driveline_qemu::children::Folder;
use zip::ZipArchive;

use super::description::{Description, Version};
use super::fmi::Instance;

/// An FMU with an instance of it.
pub struct Fmu {
    /// Its description.
    pub description: Description,
    /// Its instance.
    pub instance: Instance,
    _folder: Folder,
}

impl Fmu {
    /// Opens a file.
    ///
    /// # Errors
    /// A sentence with the file's name: no FMU, none for this computer, none for co-simulation.
    pub fn open(path: &Path) -> Result<Self, String> {
        let of = |error: String| format!("{}: {error}", path.display());
        let file = File::open(path).map_err(|error| of(error.to_string()))?;
        Self::read(file).map_err(of)
    }

    /// Opens the bytes of a file.
    ///
    /// # Errors
    /// As [`open`](Self::open), without a name.
    pub fn read(file: impl Read + Seek) -> Result<Self, String> {
        let no_fmu = |error: &dyn std::fmt::Display| format!("it is no FMU: {error}");
        let folder = Folder::make().map_err(|error| error.to_string())?;
        let unpacked = ZipArchive::new(file).and_then(|mut archive| archive.extract(folder.path()));
        unpacked.map_err(|error| no_fmu(&error))?;
        let text = std::fs::read_to_string(folder.path().join("modelDescription.xml"));
        let description = Description::read(&text.map_err(|error| no_fmu(&format!("modelDescription.xml: {error}")))?)?;
        let three = format!("{ARCH}-{}", if OS == "macos" { "darwin" } else { OS });
        // FMI 2.0 has names for x86 alone; others take those of 3.0
        let two = match (OS, ARCH) {
            ("linux", "x86_64") => "linux64",
            ("macos", "x86_64") => "darwin64",
            _ => &*three,
        };
        let platform = if description.version == Version::Two { two } else { &*three };
        let library = format!("binaries/{platform}/{}{DLL_SUFFIX}", description.identifier);
        let path = folder.path().join(&library);
        if !path.is_file() {
            return Err(format!("`{}` has no {library}, the library for this computer", description.model));
        }
        let instance = Instance::new(&description, &path, &folder.path().join("resources"))?;
        Ok(Self { description, instance, _folder: folder })
    }
}
