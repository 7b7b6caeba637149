//! Most wait states of code in a flash memory that keeps the line it read last, without a cache.
//!
//! - Code that goes on reads each line once.
//! - A taken branch waits twice: for a reading under way, which nothing may stop, and for the line that it goes to.
//! - A load may be of constants in flash. Each word then waits, and so does the code after it, whose line has gone.
//!   Where the stack pointer is the base it is of the stack, which is no flash.
//! - A store waits for nothing.
//! - A branch that is not taken waits as a taken one on the M3 and M4, which fetch its target early.
//!
//! A cache or a prefetch buffer shortens it, to nothing at best: the least is without wait states.

/// A flash memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Flash {
    /// Wait states of a reading (cycles).
    pub wait_states: u64,
    /// Bytes of a line, a power of two from 2 on.
    pub line: u32,
}

impl Flash {
    /// One that answers at once.
    pub const IDEAL: Self = Flash { wait_states: 0, line: 16 };

    /// Cycles that an instruction waits where the one before it was the one executed before.
    pub(crate) fn straight(self, at: u32, size: u32, code: (u16, u16)) -> u64 {
        let of = |address: u32| u64::from(address / self.line.max(1));
        let lines = if at == 0 { 1 } else { of(at + size - 1).saturating_sub(of(at - 1)) };
        self.wait_states * (lines + 2 * loaded_words(code.0, code.1))
    }

    /// Further cycles of a call, of a return, or of a branch whose target is fetched.
    pub(crate) const fn jump(self) -> u64 {
        2 * self.wait_states
    }
}

/// The stack pointer as a base.
const STACK: u16 = 13;

/// Words that an instruction loads, perhaps from flash.
pub fn loaded_words(first: u16, second: u16) -> u64 {
    if first >> 11 < 0b11101 {
        return match first >> 11 {
            0b01010 if first >> 9 & 3 < 3 => 0, // STR, STRH, STRB by a register
            0b01001 | 0b01010 | 0b01011 | 0b01101 | 0b01111 | 0b10001 => 1, // LDR and its like
            0b11001 => u64::from((first & 0xff).count_ones()), // LDM
            _ => 0,
        };
    }
    let is_load = first & 0x10 != 0 && first & 0xf != STACK;
    match first >> 9 {
        0x74 if first & 0xfff0 == 0xe8d0 => 1, // TBB, TBH and exclusive loads
        0x74 if is_load && first & 0x40 == 0 => u64::from(second.count_ones()), // LDM
        0x74 if is_load => 2,                  // LDRD
        0x76 if first & 0xffe0 == 0xec40 => 0, // VMOV of two core registers
        0x76 if is_load && first & 0xff20 == 0xed00 => {
            if second & 0x100 == 0 {
                1
            } else {
                2
            }
        } // VLDR
        0x76 if is_load => u64::from(second & 0xff), // VLDM
        0x7c if is_load => 1,                  // LDR and its like
        _ => 0,
    }
}
