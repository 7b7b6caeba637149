//! Registers of an instruction, as far as the cycles of the next one depend on them. Encodings: Arm DDI 0403E.

/// What an instruction is, to the next one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// LDR and its like: one register.
    Load,
    /// STR and its like: one register, at a constant offset.
    Store,
    /// The same at an offset in a register.
    StoreIndexed,
    /// Several registers: LDM, STM, LDRD, STRD, PUSH, POP, and exclusive accesses; TBB and TBH read a table.
    Several {
        loads: bool,
    },
    /// VLDR, VSTR, VLDM, VSTM.
    Float {
        loads: bool,
    },
    /// Arithmetic of the floating-point unit.
    Arithmetic,
    /// A branch or a call.
    Branch,
    /// IT.
    It,
    Nop,
    /// Any other.
    Data,
}

/// An instruction's registers, a bit each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Operands {
    pub kind: Kind,
    pub address: u16,
    /// The base is written back, or the offset is in a register.
    pub indexed: bool,
    pub writes: u16,
    /// Read of the floating-point unit; the addend of a sum of products not, which is consumed a cycle later.
    pub float_reads: u32,
    /// Written of the floating-point unit.
    pub float_writes: u32,
}

/// The stack pointer.
pub(crate) const SP: u16 = 13;
const PC: u16 = 15;

pub(crate) const fn bit(register: u16) -> u16 {
    1 << (register & 15)
}

/// Three bits of a short instruction that name a register.
const fn low(word: u16, at: u16) -> u16 {
    bit(word >> at & 7)
}

const NONE: Operands =
    Operands { kind: Kind::Data, address: 0, indexed: false, writes: 0, float_reads: 0, float_writes: 0 };

const fn data(writes: u16) -> Operands {
    Operands { writes, ..NONE }
}

const fn kind(kind: Kind) -> Operands {
    Operands { kind, ..NONE }
}

/// A single access: a store writes no register.
const fn access(loads: bool, address: u16, register: u16) -> Operands {
    let kind = if loads { Kind::Load } else { Kind::Store };
    Operands { kind, address, writes: if loads { register } else { 0 }, ..NONE }
}

impl Operands {
    /// Of an instruction.
    pub(crate) fn of(first: u16, second: u16) -> Self {
        if first >> 11 >= 0b11101 { long(first, second) } else { short(first) }
    }

    /// Whether it loads a constant among the code.
    pub(crate) const fn is_literal(&self) -> bool {
        self.address & bit(PC) != 0
    }
}

/// TBB or TBH.
pub(crate) const fn is_table(first: u16, second: u16) -> bool {
    first & 0xfff0 == 0xe8d0 && second & 0xffe0 == 0xf000
}

/// A5.2
fn short(word: u16) -> Operands {
    let several = |loads, base, writes| Operands { address: base, writes, ..kind(Kind::Several { loads }) };
    match word >> 10 {
        // CMP with a constant
        0b00_1010 | 0b00_1011 => NONE,
        0b00_1000..=0b00_1111 => data(low(word, 8)),
        0b00_0000..=0b00_0111 => data(low(word, 0)),
        // TST, CMP, CMN
        0b01_0000 if matches!(word >> 6 & 15, 8 | 10 | 11) => NONE,
        0b01_0000 => data(low(word, 0)),
        // ADD, CMP, MOV with high registers, BX
        0b01_0001 => match word >> 8 & 3 {
            1 => NONE,
            3 => kind(Kind::Branch),
            _ => data(bit(word >> 4 & 8 | word & 7)),
        },
        0b01_0010 | 0b01_0011 => access(true, bit(PC), low(word, 8)),
        0b01_0100..=0b01_0111 => {
            let loads = word >> 9 & 7 >= 3;
            let with = access(loads, low(word, 3) | low(word, 6), low(word, 0));
            Operands { indexed: true, kind: if loads { Kind::Load } else { Kind::StoreIndexed }, ..with }
        }
        0b01_1000..=0b10_0011 => access(word & 0x800 != 0, low(word, 3), low(word, 0)),
        0b10_0100..=0b10_0111 => access(word & 0x800 != 0, bit(SP), low(word, 8)),
        // ADR and ADD of the stack pointer
        0b10_1000..=0b10_1011 => data(low(word, 8)),
        0b10_1100..=0b10_1111 => match word >> 8 {
            0xb0 => data(bit(SP)),
            0xb1 | 0xb3 | 0xb9 | 0xbb => kind(Kind::Branch),
            0xb2 | 0xba => data(low(word, 0)),
            0xb4 | 0xb5 => several(false, bit(SP), bit(SP)),
            0xbc | 0xbd => several(true, bit(SP), bit(SP) | word & 0xff),
            0xbf if word & 0xf != 0 => kind(Kind::It),
            0xbf if word == 0xbf00 => kind(Kind::Nop),
            _ => NONE,
        },
        0b11_0000 | 0b11_0001 => several(false, low(word, 8), low(word, 8)),
        0b11_0010 | 0b11_0011 => several(true, low(word, 8), low(word, 8) | word & 0xff),
        _ => kind(Kind::Branch),
    }
}

/// A5.3
fn long(first: u16, second: u16) -> Operands {
    let base = bit(first & 0xf);
    let (top, middle) = (bit(second >> 12), bit(second >> 8));
    // comparisons have the program counter for a result
    let result = data(middle & !bit(PC));
    let loads = first & 0x10 != 0;
    match first >> 9 {
        0x74 => {
            let back = if first & 0x20 != 0 { base } else { 0 };
            let (address, writes) = match first & 0x40 == 0 {
                true => (base, if loads { second & !bit(PC) } else { 0 }),
                // a table is among the code
                false if is_table(first, second) => (base | bit(second) | bit(PC), 0),
                // exclusive accesses; STREX writes whether it stored
                false if first & 0x120 == 0 => (base, top | middle | bit(second)),
                false => (base, if loads { top | middle } else { 0 }),
            };
            Operands { address, writes: back | writes, ..kind(Kind::Several { loads }) }
        }
        0x76 => float_access(first, second),
        0x77 | 0x7e | 0x7f => float(first, second),
        // B, BL; MRS writes a register
        0x78..=0x7b if second & 0x8000 != 0 => match first {
            0xf3ef => result,
            0xf3af if second == 0x8000 => kind(Kind::Nop),
            _ if second & 0x5000 != 0 || first >> 7 & 7 != 7 => kind(Kind::Branch),
            _ => NONE,
        },
        0x7c => {
            let in_register = first & 0x80 == 0 && second & 0xfc0 == 0 && base != bit(PC);
            let back = first & 0x80 == 0 && second & 0x900 == 0x900 && base != bit(PC);
            let address = base | if in_register { bit(second) } else { 0 };
            let with = access(loads, address, top & !bit(PC));
            let kind = if in_register && !loads { Kind::StoreIndexed } else { with.kind };
            Operands { kind, indexed: in_register || back, writes: with.writes | if back { base } else { 0 }, ..with }
        }
        // a division has ones where the others have their lower register
        0x7d if first & 0x180 == 0x180 => data((top | middle) & !bit(PC)),
        _ => result,
    }
}

/// Registers of the unit, from one on.
const fn floats(from: u16, count: u16) -> u32 {
    let all = if count < 32 { (1 << count) - 1 } else { u32::MAX };
    if from < 32 { all << from } else { 0 }
}

/// One register of the unit: a single by `high` and its lowest bit, or the two singles of a double.
const fn register(high: u16, lowest: u16, second: u16) -> u32 {
    match second & 0x100 == 0 {
        true => floats(high << 1 & 0x1e | lowest & 1, 1),
        false => floats(((lowest & 1) << 4 | high & 0xf) << 1, 2),
    }
}

/// A6.5 to A6.7
fn float_access(first: u16, second: u16) -> Operands {
    let loads = first & 0x10 != 0;
    if first & 0xffe0 == 0xec40 {
        let lowest = register(second & 0xf, second >> 5, second);
        let both = lowest | lowest << 1;
        let core = bit(second >> 12) | bit(first & 0xf);
        let with = data(if loads { core } else { 0 });
        return Operands { float_reads: if loads { both } else { 0 }, ..with };
    }
    let is_one = first & 0xff20 == 0xed00;
    let from = register(second >> 12, first >> 6, second).trailing_zeros() as u16;
    let count = match (is_one, second & 0x100 == 0) {
        (true, true) => 1,
        (true, false) => 2,
        _ => second & 0xff,
    };
    let base = bit(first & 0xf);
    let all = floats(from, count);
    Operands {
        kind: Kind::Float { loads },
        address: base,
        indexed: !is_one,
        writes: if first & 0x20 != 0 && !is_one { base } else { 0 },
        float_reads: if loads { 0 } else { all },
        float_writes: if loads { all } else { 0 },
    }
}

/// A6.4 and A6.6: data processing, and one register to or from the core.
fn float(first: u16, second: u16) -> Operands {
    let destination = register(second >> 12, first >> 6, second);
    let (n, m) = (register(first, second >> 7, second), register(second, second >> 5, second));
    let of = |kind, float_reads, float_writes| Operands { kind, float_reads, float_writes, ..NONE };
    if second & 0x10 != 0 {
        return match first & 0xfff0 {
            // VMRS may write the flags alone
            0xeef0 => data(bit(second >> 12) & !bit(PC)),
            _ if first & 0x10 != 0 => Operands { float_reads: n, ..data(bit(second >> 12)) },
            _ => NONE,
        };
    }
    match first & 0xffb0 {
        0xee00 | 0xee10 | 0xee90 | 0xeea0 | 0xee20 | 0xee30 | 0xee80 => of(Kind::Arithmetic, n | m, destination),
        0xeeb0 if second & 0x40 == 0 => of(Kind::Data, 0, destination), // VMOV of a constant
        0xeeb0 if first & 0xe == 4 => of(Kind::Data, destination | if first & 1 == 0 { m } else { 0 }, 0), // VCMP
        0xeeb0 if first & 0xe == 0 && !(first & 1 == 1 && second & 0x80 != 0) => of(Kind::Data, m, destination),
        // VCVT of fixed point converts its destination
        0xeeb0 if first & 0xa == 0xa => of(Kind::Arithmetic, destination, destination),
        // VSQRT and VCVT
        0xeeb0 => of(Kind::Arithmetic, m, destination),
        // VSEL, VMAXNM, VMINNM, VRINT
        _ => of(Kind::Arithmetic, n | m, destination),
    }
}
