//! An FMU: a file, unpacked, with its description and an instance.

use std::env::consts::{ARCH, DLL_SUFFIX, OS};
use std::fs::File;
use std::io::{Read, Seek};
use std::path::Path;

use driveline_qemu::children::Folder;
use zip::ZipArchive;

use super::description::{Description, Version};
use super::fmi::Instance;

/// The most that an FMU may be unpacked, bytes: a hundred times what tools write, and no disk full.
const LARGEST: u64 = 1 << 30;

/// An FMU with an instance of it.
pub struct Fmu {
    pub description: Description,
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
    pub fn read(file: impl Read + Seek) -> Result<Self, String> {
        let no_fmu = |error: &dyn std::fmt::Display| format!("it is no FMU: {error}");
        let folder = Folder::make().map_err(|error| error.to_string())?;
        let mut archive = ZipArchive::new(file).map_err(|error| no_fmu(&error))?;
        // a file that is larger than the archive says is an error of its extraction
        let mut size = 0_u64;
        for index in 0..archive.len() {
            size = size.saturating_add(archive.by_index_raw(index).map_err(|error| no_fmu(&error))?.size());
        }
        if size > LARGEST {
            return Err(format!("it is not unpacked: expected at most {} MiB of files in it", LARGEST >> 20));
        }
        archive.extract(folder.path()).map_err(|error| no_fmu(&error))?;
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

#[cfg(test)]
mod tests {
    use std::io::{Cursor, Write};

    use zip::write::SimpleFileOptions;
    use zip::{CompressionMethod, ZipWriter};

    use super::Fmu;

    /// 600 zeros, which take a few bytes, and what the archive says of them: that they are 2 GiB, or one.
    #[test]
    fn an_archive_that_would_fill_the_disk_is_refused() {
        let mut written = ZipWriter::new(Cursor::new(Vec::new()));
        let options = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated);
        written.start_file("resources/zeros", options).unwrap();
        written.write_all(&[0; 600]).unwrap();
        let bytes = written.finish().unwrap().into_inner();
        // the size in the directory at the end
        let place = bytes.windows(4).rposition(|four| four == 600_u32.to_le_bytes()).unwrap();
        let refused = |size: u32| {
            let mut bytes = bytes.clone();
            bytes[place..place + 4].copy_from_slice(&size.to_le_bytes());
            Fmu::read(Cursor::new(bytes)).err().unwrap()
        };
        assert_eq!(refused(1 << 31), "it is not unpacked: expected at most 1024 MiB of files in it");
        assert!(refused(1).contains("larger than its declared"), "{}", refused(1));
        assert!(refused(600).contains("modelDescription.xml"), "{}", refused(600));
    }
}
