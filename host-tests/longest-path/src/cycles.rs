//! Cycles of an instruction by itself, as an interval, without wait states.
//!
//! Arm DDI 0432 (Cortex-M0), DDI 0484 (Cortex-M0+), DDI 0337I (Cortex-M3) and DDI 0439D (Cortex-M4), each table 3-1, and
//! for the floating-point unit DDI 0439D, table 7-1. The manual of the Cortex-M7 (DDI 0489) prints no cycles. What
//! depends on the instruction before is in [`neighbours`](crate::neighbours). What depends on operands or is left open:
//! - P, the refilling of the pipeline after a taken branch, on the M3 and M4: 1 to 3.
//! - A load or a store alone on the M0+: 2, or 1 at the port of a single cycle.
//! - Long multiplications of the M3 (3 to 5, with a sum 4 to 7) and divisions (2 to 12).
//! - TBB and TBH: 2 + P by the table, at least 6 by the text (DDI 0337I 3-9, DDI 0439D 3-12).
//! - VDIV and VSQRT: 14, or 1 where no instruction of the unit follows (DDI 0439D 7-6).
//! - VMOV of one word between core and unit: 2 by the manual, and a measurement of 1 would not be refuted.
//!
//! The M0 and M0+ are taken to have the fast multiplier, of one cycle: the small one takes 32.

use crate::operands::{Kind, Operands, is_table};

/// A core whose manual has the rules.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Core {
    /// Cortex-M0, with the fast multiplier.
    M0,
    /// Cortex-M0+, with the fast multiplier.
    M0Plus,
    /// Cortex-M3.
    M3,
    /// Cortex-M4, with or without its floating-point unit.
    M4,
}

impl Core {
    /// The refilling of the pipeline after a taken branch: P in the tables.
    pub(crate) const fn taken(self) -> Cycles {
        match self {
            Core::M0 => exactly(2),
            Core::M0Plus => exactly(1),
            Core::M3 | Core::M4 => between(1, 3),
        }
    }

    /// A load or a store alone; a store at a constant offset is always one on the M3 and M4.
    const fn access(self, kind: Kind) -> Cycles {
        match (self, kind) {
            (Core::M0Plus, _) => between(1, 2),
            (Core::M3 | Core::M4, Kind::Store) => exactly(1),
            _ => exactly(2),
        }
    }

    /// Whether it has an instruction: of long ones Armv6-M has BL, MRS, MSR and barriers, and the M3 no floating-point
    /// unit.
    pub(crate) const fn has(self, first: u16, second: u16) -> bool {
        if first >> 11 < 0b11101 {
            // CBZ, CBNZ and IT are of Armv7-M
            return !(self.is_small() && (first & 0xf500 == 0xb100 || first >> 8 == 0xbf && first & 0xf != 0));
        }
        match self {
            Core::M0 | Core::M0Plus => first >> 11 == 0b11110 && second & 0x8000 != 0,
            Core::M3 => first >> 10 != 0b11_1011 || second >> 9 & 7 != 5,
            Core::M4 => true,
        }
    }

    /// Whether it has the instructions of Armv6-M alone.
    pub(crate) const fn is_small(self) -> bool {
        matches!(self, Core::M0 | Core::M0Plus)
    }
}

/// Least and most cycles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cycles {
    pub least: u64,
    pub most: u64,
}

pub(crate) const fn between(least: u64, most: u64) -> Cycles {
    Cycles { least, most }
}

pub(crate) const fn exactly(cycles: u64) -> Cycles {
    between(cycles, cycles)
}

impl Cycles {
    /// Of an instruction that is executed, and not skipped, behind one that has no effect on it; a branch, which counts
    /// as not taken.
    pub fn of(core: Core, first: u16, second: u16) -> Self {
        match first >> 11 >= 0b11101 {
            true if core.is_small() => exactly(2) + core.taken(), // BL; MRS, MSR and barriers take as long
            true => long(core, first, second),
            false => short(core, first),
        }
    }
}

impl Cycles {
    /// Of one of two.
    pub(crate) fn or(self, other: Self) -> Self {
        between(self.least.min(other.least), self.most.max(other.most))
    }
}

impl std::ops::Add for Cycles {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        between(self.least + other.least, self.most + other.most)
    }
}

/// One, and one more for each of some registers.
fn registers(list: u16) -> Cycles {
    exactly(1 + u64::from(list.count_ones()))
}

/// A5.2
fn short(core: Core, word: u16) -> Cycles {
    match word >> 9 {
        0b101_1010 => return registers(word & 0x1ff), // PUSH
        // POP with the program counter; 4 + N on the M0, 3 + N on the M0+
        0b101_1110 if word & 0x100 != 0 => {
            let more = exactly(if core.is_small() { 1 } else { 0 });
            return registers(word & 0x1ff) + more + core.taken();
        }
        0b101_1110 => return registers(word & 0xff), // POP
        _ => {}
    }
    match word >> 11 {
        0b01001..=0b10011 => core.access(Operands::of(word, 0).kind), // LDR, STR and the like
        0b11000 | 0b11001 => registers(word & 0xff),                  // STM, LDM
        _ if word >> 8 == 0x47 => exactly(1) + core.taken(),          // BX, BLX
        _ if word & 0xff87 == 0x4687 || word & 0xff87 == 0x4487 => exactly(1) + core.taken(), // into the counter
        _ if word & 0xffe8 == 0xb660 && !core.is_small() => between(1, 2), // CPS
        _ => exactly(1),
    }
}

/// A5.3
fn long(core: Core, first: u16, second: u16) -> Cycles {
    let m3 = core == Core::M3;
    let into_counter = if second & 0x8000 != 0 { core.taken() } else { exactly(0) };
    match first >> 9 {
        // LDM, STM; LDM may load the program counter
        0x74 if first & 0x40 == 0 && first & 0x10 != 0 => registers(second) + into_counter,
        0x74 if first & 0x40 == 0 => registers(second),
        0x74 if is_table(first, second) => between(2, 3),
        0x74 if first & 0x120 == 0 => exactly(2), // exclusive accesses
        0x74 => exactly(3),                       // LDRD, STRD
        0x76 => floating_access(first, second),
        0x77 if second & 0x10 == 0 => floating(first, second),
        0x77 if first & 0xffe0 == 0xee00 => between(1, 2), // VMOV of a word between core and unit
        // BL and control: barriers, special registers
        0x78..=0x7b if second & 0xd000 == 0xd000 => exactly(1) + core.taken(),
        0x78..=0x7b if second & 0xd000 == 0x8000 && first >> 7 & 7 == 7 => between(1, 4),
        0x7c if first & 0x10 != 0 && second >> 12 == 15 => exactly(2) + core.taken(), // LDR into the program counter
        0x7c => core.access(Operands::of(first, second).kind),
        0x7d => match first >> 4 & 0x1f {
            0x10 if second >> 12 != 15 && m3 => exactly(2), // MLA, MLS
            0x19 | 0x1b => between(2, 12),                  // SDIV, UDIV
            0x18 | 0x1a if m3 => between(3, 5),             // SMULL, UMULL
            0x1c | 0x1e if m3 => between(4, 7),             // SMLAL, UMLAL
            _ => exactly(1),
        },
        _ => exactly(1),
    }
}

/// VLDR, VSTR and several registers; two core registers to or from the unit.
fn floating_access(first: u16, second: u16) -> Cycles {
    let words = u64::from(second & 0xff);
    match first {
        _ if first & 0xffe0 == 0xec40 => exactly(2),
        // one register: of two words where it is a double
        _ if first & 0xff20 == 0xed00 => exactly(if second & 0x100 == 0 { 2 } else { 3 }),
        _ => exactly(1 + words),
    }
}

/// Arithmetic of the unit.
fn floating(first: u16, second: u16) -> Cycles {
    match first & 0xffb0 {
        0xee00 | 0xee10 | 0xee90 | 0xeea0 => exactly(3), // VMLA, VMLS, VNMLA, VNMLS, VFMA, VFMS, VFNMA, VFNMS
        0xee80 => between(1, 14),                        // VDIV
        0xeeb0 if first & 0xf == 1 && second & 0xc0 == 0xc0 => between(1, 14), // VSQRT
        _ => exactly(1),
    }
}
