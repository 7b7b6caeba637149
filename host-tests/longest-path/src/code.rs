//! Machine code and the functions in it, read from an ELF file.

use object::elf::SHF_EXECINSTR;
use object::read::elf::ElfFile32;
use object::{Endianness, Object, ObjectSection, ObjectSymbol, SectionFlags, SymbolKind};

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Function {
    /// Its name, as in the file.
    pub name: String,
    /// Its first instruction, without the bit that marks Thumb code.
    pub start: u32,
    /// The address after its last byte, constants among its code included.
    pub end: u32,
}

impl Function {
    /// Its name as in the source, without the compiler's hash.
    pub fn readable(&self) -> String {
        format!("{:#}", rustc_demangle::demangle(&self.name))
    }
}

/// Why a file was not read.
#[derive(Debug, thiserror::Error)]
#[error("not a 32-bit ELF file: {0}")]
pub struct NotReadable(#[from] object::Error);

/// Code of a program, its functions and the constants among it.
#[derive(Clone, Debug, Default)]
pub struct Code {
    /// Address and bytes of each section.
    sections: Vec<(u32, Vec<u8>)>,
    /// By address.
    functions: Vec<Function>,
    /// Ranges of constants, by address.
    constants: Vec<(u32, u32)>,
}

impl Code {
    /// Reads a linked ELF file. The mapping symbols `$t` and `$d` (Arm IHI 0044, 5.5.5) separate code from constants.
    pub fn read(bytes: &[u8]) -> Result<Self, NotReadable> {
        let file = ElfFile32::<Endianness>::parse(bytes)?;
        let mut code = Code::default();
        let mut marks = Vec::new();
        for symbol in file.symbols() {
            let Ok(name) = symbol.name() else { continue };
            let address = symbol.address() as u32 & !1;
            if symbol.kind() == SymbolKind::Text && symbol.size() > 0 {
                let end = address + symbol.size() as u32;
                code.functions.push(Function { name: name.into(), start: address, end });
            } else if name == "$d" || name.starts_with("$d.") {
                marks.push((address, true));
            } else if name == "$t" || name.starts_with("$t.") {
                marks.push((address, false));
            }
        }
        code.functions.sort_by(|a, b| (a.start, &a.name).cmp(&(b.start, &b.name)));
        marks.sort_unstable();
        for section in file.sections() {
            let SectionFlags::Elf { sh_flags, .. } = section.flags() else { continue };
            if sh_flags & SHF_EXECINSTR == SHF_EXECINSTR {
                let start = section.address() as u32;
                let bytes = section.data()?.to_vec();
                let end = start + bytes.len() as u32;
                let here: Vec<_> = marks.iter().filter(|(at, _)| (start..end).contains(at)).collect();
                let ends = here.iter().skip(1).map(|(at, _)| *at).chain([end]);
                let ranges = here.iter().zip(ends).filter(|((_, is_constant), _)| *is_constant);
                code.constants.extend(ranges.map(|(&&(at, _), end)| (at, end)));
                code.sections.push((start, bytes));
            }
        }
        Ok(code)
    }

    /// Functions as halfwords, the first at `start`, one behind the other, and the ranges of constants among them.
    pub fn of(start: u32, functions: &[(&str, &[u16])], constants: &[(u32, u32)]) -> Self {
        let mut code = Code { constants: constants.to_vec(), ..Code::default() };
        let mut bytes = Vec::new();
        for (name, halfwords) in functions {
            let begin = start + bytes.len() as u32;
            bytes.extend(halfwords.iter().flat_map(|halfword| halfword.to_le_bytes()));
            code.functions.push(Function { name: (*name).into(), start: begin, end: start + bytes.len() as u32 });
        }
        code.sections.push((start, bytes));
        code
    }

    /// The functions, by address.
    pub fn functions(&self) -> &[Function] {
        &self.functions
    }

    pub fn named(&self, name: &str) -> Option<&Function> {
        self.functions.iter().find(|function| function.name == name)
    }

    /// The function that begins at an address; of aliases the first by name.
    pub fn at(&self, start: u32) -> Option<&Function> {
        self.functions.iter().find(|function| function.start == start & !1)
    }

    /// The halfword at an address, where there is code.
    pub(crate) fn halfword(&self, at: u32) -> Option<u16> {
        let bytes = self.data(at, 2).filter(|_| self.constants_at(at).is_none());
        bytes.map(|bytes| u16::from_le_bytes([bytes[0], bytes[1]]))
    }

    /// The end of the constants that an address is among.
    pub(crate) fn constants_at(&self, at: u32) -> Option<u32> {
        self.constants.iter().find(|(start, end)| (*start..*end).contains(&at)).map(|(_, end)| *end)
    }

    /// Bytes at an address, code or not.
    pub(crate) fn data(&self, at: u32, length: usize) -> Option<&[u8]> {
        self.sections.iter().find_map(|(start, bytes)| {
            let from = at.checked_sub(*start)? as usize;
            bytes.get(from..from.checked_add(length)?)
        })
    }
}
