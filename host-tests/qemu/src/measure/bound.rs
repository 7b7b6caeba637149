//! Upper bounds of a measured call, from the machine code of its image.

use std::fs;
use std::path::Path;

use driveline_longest_path::{Bound, Bounds, Code, Core, Cycles, Flash, Loops, Piece, Refusal};

use crate::image::ReadError;

/// The functions without work that a count is compared with: their instructions are in no count.
const EMPTY: [&str; 2] = ["driveline_firmware::measure::count::nothing", "driveline_firmware::measure::count::no_step"];

/// The machine code of an image.
#[derive(Debug)]
pub struct MachineCode {
    code: Code,
    loops: Loops,
    /// Instructions of an empty function.
    empty: u64,
}

impl MachineCode {
    /// Reads an ELF file. Loops turn at most as often as stated.
    ///
    /// # Errors
    /// A file that cannot be read or is of another format.
    pub fn read(path: &Path, loops: Loops) -> Result<Self, ReadError> {
        let bytes = fs::read(path).map_err(|error| ReadError::File { path: path.into(), error })?;
        let code = Code::read(&bytes).map_err(|error| ReadError::Code { path: path.into(), error })?;
        let empty = code.functions().iter().filter(|function| EMPTY.contains(&function.readable().as_str()));
        let none = Loops::default();
        let mut bounds = Bounds::new(&code, &none);
        let empty = empty.filter_map(|function| Some(bounds.of(function.start).ok()?.instructions)).min().unwrap_or(0);
        Ok(MachineCode { code, loops, empty })
    }

    /// The address of a function by its name, as in the source or as in the file.
    pub fn find(&self, name: &str) -> Option<u32> {
        let mut functions = self.code.functions().iter();
        functions.find(|function| function.name == name || function.readable() == name).map(|function| function.start)
    }

    /// Whether a function begins at an address; the bit that marks Thumb code is ignored.
    pub fn begins_function(&self, start: u32) -> bool {
        self.code.functions().iter().any(|function| function.start == start & !1)
    }

    /// The bound of the function at an address, as the board counts: without an empty function.
    pub fn bound(&self, start: u32) -> Result<Bound, Refusal> {
        let Bound { instructions, stack } = Bounds::new(&self.code, &self.loops).of(start)?;
        Ok(Bound { instructions: instructions.saturating_sub(self.empty), stack })
    }

    /// The cycles of a call on a core with code in a flash, all of it.
    pub fn cycles(&self, start: u32, core: Core, flash: Flash) -> Result<Cycles, Refusal> {
        Bounds::cycles(&self.code, &self.loops, core, flash, start)
    }

    /// The cycles of a call as a board counts them, without an empty function: `None` where that has none, or where the
    /// function is unbounded.
    pub fn counted_cycles(&self, start: u32, core: Core, flash: Flash) -> Option<Cycles> {
        let cycles = |start| self.cycles(start, core, flash).ok();
        let (call, nothing) = (cycles(start)?, cycles(self.find(EMPTY[0])?)?);
        let less = |all: u64, empty| all.saturating_sub(empty);
        Some(Cycles { least: less(call.least, nothing.least), most: less(call.most, nothing.most) })
    }

    /// Its longest path, all of it.
    pub fn path(&self, start: u32) -> Result<Vec<Piece>, Refusal> {
        Bounds::new(&self.code, &self.loops).path(start)
    }
}
