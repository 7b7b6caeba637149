//! Flash and RAM of an ELF file, by section and by symbol.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use driveline_longest_path::NotReadable;
use object::elf::{SHF_ALLOC, SHF_EXECINSTR, SHF_WRITE, SHT_NOBITS};
use object::read::elf::ElfFile32;
use object::{Endianness, Object, ObjectSection, ObjectSymbol, SectionFlags, SymbolKind};

use super::calls;
use super::symbols::Symbol;

/// Why an image could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    #[error("{path}: {error}", path = path.display())]
    File { path: PathBuf, error: io::Error },
    #[error("{path} is not a 32-bit ELF image: {error}", path = path.display())]
    Format { path: PathBuf, error: object::Error },
    #[error("{path}: {error}", path = path.display())]
    Code { path: PathBuf, error: NotReadable },
}

/// Bytes of an image by what they are for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Sizes {
    /// Code, with the constants among it.
    pub text: u64,
    /// Constants, and the vector table.
    pub constants: u64,
    /// Variables that start with a value: in flash and in RAM.
    pub data: u64,
    /// Variables that start at zero or with nothing.
    pub zeroed: u64,
}

impl Sizes {
    /// Bytes of flash.
    pub fn flash(&self) -> u64 {
        self.text + self.constants + self.data
    }

    /// Bytes of RAM, without the stack.
    pub fn ram(&self) -> u64 {
        self.data + self.zeroed
    }
}

/// Data read from an image.
#[derive(Clone, Debug)]
pub struct Contents {
    /// Bytes by what they are for.
    pub sizes: Sizes,
    /// Sections that take memory, by address: name and bytes.
    pub sections: Vec<(String, u64)>,
    /// Functions and variables, by address.
    pub symbols: Vec<Symbol>,
    /// Bytes of the tick: `driveline_tick`, and every function that it calls directly or through others.
    pub tick_code: u64,
}

impl Contents {
    /// Reads an image.
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        let bytes = fs::read(path).map_err(|error| ReadError::File { path: path.into(), error })?;
        let file =
            ElfFile32::<Endianness>::parse(&*bytes).map_err(|error| ReadError::Format { path: path.into(), error })?;
        let symbols = symbols(&file);
        let tick_code = calls::reached(&file, &symbols, "driveline_tick").iter().map(|symbol| symbol.size).sum();
        Ok(Contents { sizes: sizes(&file), sections: sections(&file), symbols, tick_code })
    }

    /// Bytes of the function at an address and of every function that it calls directly or through others.
    pub fn reached_from(path: &Path, address: u64) -> Result<u64, ReadError> {
        let bytes = fs::read(path).map_err(|error| ReadError::File { path: path.into(), error })?;
        let file =
            ElfFile32::<Endianness>::parse(&*bytes).map_err(|error| ReadError::Format { path: path.into(), error })?;
        let symbols = symbols(&file);
        // Bit 0 of a pointer to Thumb code is the instruction set.
        let Some(function) = symbols.iter().find(|symbol| symbol.is_function && symbol.address == address & !1) else {
            return Ok(0);
        };
        Ok(calls::reached(&file, &symbols, &function.name).iter().map(|symbol| symbol.size).sum())
    }

    pub fn symbol(&self, name: &str) -> Option<&Symbol> {
        self.symbols.iter().find(|symbol| symbol.name == name)
    }
}

fn sizes(file: &ElfFile32<'_>) -> Sizes {
    let mut sizes = Sizes::default();
    for section in file.sections() {
        let SectionFlags::Elf { sh_type, sh_flags } = section.flags() else {
            continue;
        };
        let has = |flag| sh_flags & flag == flag;
        if !has(SHF_ALLOC) {
            continue;
        }
        let place = match (sh_type == SHT_NOBITS, has(SHF_EXECINSTR), has(SHF_WRITE)) {
            (true, ..) => &mut sizes.zeroed,
            (false, true, _) => &mut sizes.text,
            (false, false, true) => &mut sizes.data,
            (false, false, false) => &mut sizes.constants,
        };
        *place += section.size();
    }
    sizes
}

fn sections(file: &ElfFile32<'_>) -> Vec<(String, u64)> {
    let allocated = |flags| matches!(flags, SectionFlags::Elf { sh_flags, .. } if sh_flags & SHF_ALLOC == SHF_ALLOC);
    let taken = file.sections().filter(|section| allocated(section.flags()) && section.size() > 0);
    taken.filter_map(|section| Some((section.name().ok()?.into(), section.size()))).collect()
}

pub(super) fn symbols(file: &ElfFile32<'_>) -> Vec<Symbol> {
    let mut symbols: Vec<_> = file
        .symbols()
        .filter(|symbol| matches!(symbol.kind(), SymbolKind::Text | SymbolKind::Data) && symbol.size() > 0)
        .filter_map(|symbol| {
            let is_function = symbol.kind() == SymbolKind::Text;
            let address = if is_function { symbol.address() & !1 } else { symbol.address() };
            Some(Symbol { name: symbol.name().ok()?.into(), address, size: symbol.size(), is_function })
        })
        .collect();
    symbols.sort_by(|a, b| (a.address, &a.name).cmp(&(b.address, &b.name)));
    symbols
}
