//! The tick's machine code without what only the linker decides: where functions and tables lie.
//!
//! A branch to another function and an address in two halves (`MOVW`, `MOVT`) or in a literal pool are taken out of the
//! code and kept as what they refer to, by name and, for a table, with all its bytes. Everything else is compared as it
//! stands. Encodings: Arm DDI 0403E, A7.7.12, A7.7.76, A7.7.79.

use std::fs;
use std::path::Path;

use object::elf::SHF_ALLOC;
use object::read::elf::ElfFile32;
use object::{Endianness, Object, ObjectSection, SectionFlags};

use super::calls::{constants, halfword, reached, target};
use super::sections::{ReadError, symbols};
use super::symbols::Symbol;

/// A function of the tick.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Function {
    /// Its name, without the compiler's hash.
    pub name: String,
    /// Its halfwords, those with an address without it.
    pub code: Vec<u16>,
    /// Object of the addresses.
    pub referents: Vec<Referent>,
}

/// Object of an address in a function.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Referent {
    /// Bytes from the function's start to the instruction.
    pub at: u64,
    /// The function or variable, without the compiler's hash; the address itself where no symbol has it.
    pub name: String,
    /// Bytes from its start.
    pub offset: u64,
    /// The bytes of a table; nothing of a function or of a variable that starts at zero.
    pub bytes: Vec<u8>,
}

/// Reads `driveline_tick` and every function that it calls directly or through others from an image.
pub fn tick_code(path: &Path) -> Result<Vec<Function>, ReadError> {
    let bytes = fs::read(path).map_err(|error| ReadError::File { path: path.into(), error })?;
    let file =
        ElfFile32::<Endianness>::parse(&*bytes).map_err(|error| ReadError::Format { path: path.into(), error })?;
    let symbols = symbols(&file);
    let reader = Reader { file: &file, symbols: &symbols };
    Ok(reached(&file, &symbols, "driveline_tick").into_iter().map(|symbol| reader.function(symbol)).collect())
}

struct Reader<'f> {
    file: &'f ElfFile32<'f>,
    symbols: &'f [Symbol],
}

impl Reader<'_> {
    fn function(&self, symbol: &Symbol) -> Function {
        let (start, end) = (symbol.address, symbol.address + symbol.size);
        let pools = constants(self.file, symbol);
        let mut code: Vec<u16> = (start..end).step_by(2).filter_map(|at| halfword(self.file, at)).collect();
        let mut referents = Vec::new();
        // halfword of a MOVW and its value, by its register
        let mut lower: [Option<(usize, u32)>; 16] = [None; 16];
        let mut at = 0;
        while let Some(&first) = code.get(at) {
            let (offset, second) = (2 * at as u64, code.get(at + 1).copied().unwrap_or(0));
            let in_pool = pools.iter().any(|&(from, to)| (from..to).contains(&(start + offset)));
            let is_wide = in_pool || first >> 11 >= 0b11101;
            let mut masks = Vec::new();
            let mut refer = |address: u32| {
                referents.push(self.referent(offset, address));
            };
            if in_pool {
                let word = u32::from(first) | u32::from(second) << 16;
                if self.is_place(word) {
                    refer(word);
                    masks.extend([(at, 0xffff), (at + 1, 0xffff)]);
                }
            } else if let Some(called) = target(start + offset, first, second).filter(|to| !(start..end).contains(to)) {
                refer(called as u32);
                masks.extend(if is_wide { [(at, 0x07ff), (at + 1, 0x2fff)] } else { [(at, 0x07ff); 2] });
            } else if first & 0xfbf0 == 0xf240 && second & 0x8000 == 0 {
                lower[usize::from(second >> 8 & 0xf)] = Some((at, half(first, second)));
            } else if first & 0xfbf0 == 0xf2c0 && second & 0x8000 == 0 {
                let pair = lower[usize::from(second >> 8 & 0xf)];
                if let Some((low, address)) = pair.map(|(low, value)| (low, value | half(first, second) << 16))
                    && self.is_place(address)
                {
                    refer(address);
                    masks.extend([(low, 0x040f), (low + 1, 0x70ff), (at, 0x040f), (at + 1, 0x70ff)]);
                }
            }
            for (place, mask) in masks {
                if let Some(halfword) = code.get_mut(place) {
                    *halfword &= !mask;
                }
            }
            at += if is_wide { 2 } else { 1 };
        }
        Function { name: plain(&symbol.name), code, referents }
    }

    /// Whether a word is an address in the image.
    fn is_place(&self, word: u32) -> bool {
        let word = u64::from(word);
        self.file.sections().any(|section| {
            let allocated =
                matches!(section.flags(), SectionFlags::Elf { sh_flags, .. } if sh_flags & SHF_ALLOC == SHF_ALLOC);
            // a lower value may as well be a number
            allocated && word >= 0x400 && (section.address()..section.address() + section.size()).contains(&word)
        })
    }

    fn referent(&self, at: u64, address: u32) -> Referent {
        let address = u64::from(address & !1);
        let holder =
            self.symbols.iter().find(|symbol| (symbol.address..symbol.address + symbol.size).contains(&address));
        let Some(symbol) = holder else {
            return Referent { at, name: format!("{address:#x}"), offset: 0, bytes: Vec::new() };
        };
        let data = |symbol: &Symbol| {
            let sections = self.file.sections();
            let mut bytes = sections.filter_map(|section| section.data_range(symbol.address, symbol.size).ok()?);
            bytes.next().map_or_else(Vec::new, <[u8]>::to_vec)
        };
        let bytes = if symbol.is_function { Vec::new() } else { data(symbol) };
        Referent { at, name: plain(&symbol.name), offset: address - symbol.address, bytes }
    }
}

/// The 16 bits of a MOVW or MOVT: imm4:i:imm3:imm8.
fn half(first: u16, second: u16) -> u32 {
    let (first, second) = (u32::from(first), u32::from(second));
    (first & 0xf) << 12 | (first >> 10 & 1) << 11 | (second >> 12 & 7) << 8 | second & 0xff
}

/// A name without the hash at its end; tables without names of their own are alike.
fn plain(name: &str) -> String {
    if name.starts_with(".Lanon.") {
        return ".Lanon".into();
    }
    match name.rfind("17h") {
        Some(at) if name.len() == at + 20 && name.ends_with('E') => name[..at].into(),
        _ => name.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::{half, plain};

    #[test]
    fn the_halves_of_an_address_are_put_together() {
        // assembled by LLVM: movw r3, #0xc090; movt r3, #0x800
        assert_eq!(half(0xf24c, 0x0390) | half(0xf6c0, 0x0300) << 16, 0x0800_c090);
    }

    #[test]
    fn a_name_loses_its_hash_alone() {
        assert_eq!(plain("_ZN9driveline5drive4tick17hf81834d1bbfbf854E"), "_ZN9driveline5drive4tick");
        assert_eq!(plain("driveline_tick"), "driveline_tick");
    }
}
