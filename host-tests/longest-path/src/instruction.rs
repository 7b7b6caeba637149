//! One instruction: its length, where execution goes after it, and its effect on the stack pointer.
//!
//! Sections of Arm DDI 0403E stand beside the encodings. An encoding that the manual calls unpredictable because it
//! writes the program counter or the stack pointer is [`Flow::Unknown`] or [`Stack::Unknown`].

/// Where execution goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flow {
    /// To the next instruction.
    Next,
    /// To the next `instructions` of an `IT` block, each on a condition.
    It {
        /// From one to four.
        instructions: u8,
    },
    /// To an address; where `conditional`, or to the next instruction.
    Branch {
        /// The address.
        target: u32,
        /// Whether it may be not taken.
        conditional: bool,
    },
    /// Into a function and back to the next instruction.
    Call {
        /// The function's address.
        target: u32,
    },
    /// Back to the caller.
    Return,
    /// To an entry of a table of offsets: forward by twice the entry.
    Table {
        /// Whether entries have two bytes.
        wide: bool,
        /// Register with the table's address; the program counter for a table that follows.
        base: u16,
    },
    /// Nowhere: an undefined instruction, which the compiler puts where execution cannot come.
    Trap,
    /// To an address in a register or in memory, or out of the program.
    Unknown,
}

/// Effect on the stack pointer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stack {
    /// None.
    Same,
    /// Bytes by which the stack grows; negative where it shrinks.
    Grows(i32),
    /// A value that is not known from the instruction alone.
    Unknown,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instruction {
    /// Bytes: two or four.
    pub size: u32,
    /// Where execution goes.
    pub flow: Flow,
    /// Effect on the stack pointer.
    pub stack: Stack,
}

use crate::operands::{SP, is_table};

const LR: u16 = 14;
/// The program counter.
pub const PC: u16 = 15;

impl Instruction {
    /// Decodes the instruction at `at`; the second halfword is not looked at in a short one.
    pub fn decode(at: u32, first: u16, second: u16) -> Self {
        // A5.1
        if first >> 11 >= 0b11101 {
            let (flow, stack) = long(at, first, second);
            Instruction { size: 4, flow, stack }
        } else {
            let (flow, stack) = short(at, first);
            Instruction { size: 2, flow, stack }
        }
    }

    /// Whether an instruction that begins with this halfword has two.
    pub fn is_long(first: u16) -> bool {
        first >> 11 >= 0b11101
    }
}

const NEXT: (Flow, Stack) = (Flow::Next, Stack::Same);
const UNKNOWN: (Flow, Stack) = (Flow::Unknown, Stack::Same);
const COMPUTED: (Flow, Stack) = (Flow::Next, Stack::Unknown);

/// A5.2
fn short(at: u32, word: u16) -> (Flow, Stack) {
    let branch = |bits: u32, conditional| {
        let offset = u32::from(word) << (32 - bits);
        Flow::Branch { target: target(at, (offset as i32) >> (31 - bits)), conditional }
    };
    let registers = (word & 0x1ff).count_ones() as i32;
    match word >> 8 {
        // ADD, MOV with high registers, A7.7.4 and A7.7.77; the register is D:Rd
        0x44 | 0x46 => match word >> 4 & 8 | word & 7 {
            SP => COMPUTED,
            PC => UNKNOWN,
            _ => NEXT,
        },
        // BX, A7.7.20; a BX of the other security state has bit 2, A BLX bit 7
        0x47 if word & 0xff == LR << 3 => (Flow::Return, Stack::Same),
        0x47 => UNKNOWN,
        // ADD and SUB of the stack pointer, A7.7.5 and A7.7.176
        0xb0 => {
            let bytes = i32::from(word & 0x7f) * 4;
            (Flow::Next, Stack::Grows(if word & 0x80 == 0 { -bytes } else { bytes }))
        }
        // CBZ and CBNZ, A7.7.21
        0xb1 | 0xb3 | 0xb9 | 0xbb => {
            let offset = word >> 3 & 0x40 | word >> 2 & 0x3e;
            (Flow::Branch { target: target(at, i32::from(offset)), conditional: true }, Stack::Same)
        }
        // PUSH and POP, A7.7.101 and A7.7.99; POP with the program counter returns
        0xb4 | 0xb5 => (Flow::Next, Stack::Grows(4 * registers)),
        0xbc => (Flow::Next, Stack::Grows(-4 * registers)),
        0xbd => (Flow::Return, Stack::Grows(-4 * registers)),
        // BKPT leaves the program
        0xbe => UNKNOWN,
        // IT, A7.7.38: the lowest bit set of the mask ends the block; without one it is a hint
        0xbf if word & 0xf != 0 => (Flow::It { instructions: 4 - (word & 0xf).trailing_zeros() as u8 }, Stack::Same),
        // UDF and SVC, A5.2.6
        0xde => (Flow::Trap, Stack::Same),
        0xdf => UNKNOWN,
        // B, A7.7.12: T1 with a condition, T2
        0xd0..=0xdd => (branch(8, true), Stack::Same),
        0xe0..=0xe7 => (branch(11, false), Stack::Same),
        _ => NEXT,
    }
}

/// A5.3
fn long(at: u32, first: u16, second: u16) -> (Flow, Stack) {
    let base = first & 0xf;
    let top = second >> 12;
    match first >> 9 {
        // 1110 100: several registers, A5.3.5; bit 6 of the first half makes it a dual or exclusive access, A5.3.6
        0x74 if first & 0x40 == 0 => several(first, second),
        0x74 => dual(first, second),
        // 1110 101: data processing with a shifted register, A5.3.11
        0x75 => result(first, second),
        // 1110 110, 1110 111, 1111 110, 1111 111: coprocessors and the floating-point unit, A5.3.18
        0x76 => coprocessor(first, second),
        0x7e if base == SP && first & 0x20 != 0 => COMPUTED,
        0x77 | 0x7e | 0x7f => NEXT,
        // 1111 0: branches and control, A5.3.4
        0x78..=0x7b if second & 0x8000 != 0 => control(at, first, second),
        // immediates, A5.3.1 and A5.3.3
        0x78 | 0x7a => immediate(first, second),
        0x79 | 0x7b => match first & 0xfbf0 {
            // ADDW and SUBW, A7.7.5 and A7.7.176
            form @ (0xf200 | 0xf2a0) if base == SP && second >> 8 & 0xf == SP => {
                let bytes = twelve_bits(first, second) as i32;
                (Flow::Next, Stack::Grows(if form == 0xf200 { -bytes } else { bytes }))
            }
            _ => written(second >> 8 & 0xf),
        },
        // 1111 100: single loads and stores, A5.3.7 to A5.3.10
        0x7c => single(first, second, base, top),
        // 1111 101: register operands, A5.3.12; multiplications, A5.3.16 and A5.3.17, write no such register
        0x7d if first & 0x100 == 0 => written(second >> 8 & 0xf),
        0x7d => NEXT,
        _ => UNKNOWN,
    }
}

/// An instruction that writes a register and does nothing else.
fn written(register: u16) -> (Flow, Stack) {
    match register {
        SP => COMPUTED,
        PC => UNKNOWN,
        _ => NEXT,
    }
}

/// A data-processing instruction: without a result, the register 15 of a comparison, where it sets the flags.
fn result(first: u16, second: u16) -> (Flow, Stack) {
    let register = second >> 8 & 0xf;
    // TST, TEQ, CMN, CMP, A5.3.1
    let compares = first & 0x10 != 0 && matches!(first >> 5 & 0xf, 0 | 4 | 8 | 13);
    if register == PC && compares { NEXT } else { written(register) }
}

/// ADD and SUB of the stack pointer and a constant, A7.7.5 and A7.7.176, and the others of A5.3.1.
fn immediate(first: u16, second: u16) -> (Flow, Stack) {
    let is_stack = first & 0xf == SP && second >> 8 & 0xf == SP;
    match first >> 5 & 0xf {
        operation @ (8 | 13) if is_stack => {
            let bytes = expanded(twelve_bits(first, second)) as i32;
            (Flow::Next, Stack::Grows(if operation == 8 { bytes.wrapping_neg() } else { bytes }))
        }
        _ => result(first, second),
    }
}

/// i:imm3:imm8
fn twelve_bits(first: u16, second: u16) -> u32 {
    u32::from(first >> 10 & 1) << 11 | u32::from(second >> 12 & 7) << 8 | u32::from(second & 0xff)
}

/// ThumbExpandImm, A5.3.2.
fn expanded(twelve: u32) -> u32 {
    let byte = twelve & 0xff;
    match twelve >> 8 {
        0 => byte,
        1 => byte << 16 | byte,
        2 => byte << 24 | byte << 8,
        3 => byte << 24 | byte << 16 | byte << 8 | byte,
        _ => (byte & 0x7f | 0x80).rotate_right(twelve >> 7),
    }
}

/// The register and the address that ADR puts in it, A7.7.7, encoding T3.
pub fn address(at: u32, first: u16, second: u16) -> Option<(u16, u32)> {
    let twelve = u32::from(first >> 10 & 1) << 11 | u32::from(second >> 12 & 7) << 8 | u32::from(second & 0xff);
    (first & 0xfbff == 0xf20f && second & 0x8000 == 0).then_some((second >> 8 & 0xf, ((at + 4) & !3) + twelve))
}

/// LDM and STM, A7.7.41, A7.7.42, A7.7.159 and A7.7.160.
fn several(first: u16, second: u16) -> (Flow, Stack) {
    let (loads, writes_back) = (first & 0x10 != 0, first & 0x20 != 0);
    let bytes = 4 * second.count_ones() as i32;
    let stack = match (first & 0xf == SP && writes_back, loads, first >> 7 & 3) {
        (false, ..) => Stack::Same,
        (true, true, 1) => Stack::Grows(-bytes),
        (true, false, 2) => Stack::Grows(bytes),
        _ => Stack::Unknown,
    };
    let flow = match (loads && second & 1 << PC != 0, stack) {
        (false, _) => Flow::Next,
        (true, Stack::Grows(_)) => Flow::Return,
        _ => Flow::Unknown,
    };
    (flow, stack)
}

/// LDRD and STRD, A7.7.50 and A7.7.166; exclusive accesses; TBB and TBH, A7.7.185.
fn dual(first: u16, second: u16) -> (Flow, Stack) {
    let base = first & 0xf;
    if is_table(first, second) {
        return (Flow::Table { wide: second & 0x10 != 0, base }, Stack::Same);
    }
    if base != SP || first & 0x20 == 0 {
        return NEXT;
    }
    moved(4 * i32::from(second & 0xff), first & 0x80 != 0)
}

/// Writes the stack pointer back, upwards or downwards.
fn moved(bytes: i32, up: bool) -> (Flow, Stack) {
    (Flow::Next, Stack::Grows(if up { -bytes } else { bytes }))
}

/// VLDM, VSTM, VPUSH, VPOP and the loads and stores of other coprocessors, A6.6 and A7.7.39; with all of P, U and W
/// zero it is a transfer of two registers.
fn coprocessor(first: u16, second: u16) -> (Flow, Stack) {
    if first & 0xf != SP || first & 0x20 == 0 {
        return NEXT;
    }
    moved(4 * i32::from(second & 0xff), first & 0x80 != 0)
}

/// B, BL, and the control instructions, A5.3.4.
fn control(at: u32, first: u16, second: u16) -> (Flow, Stack) {
    let (sign, j1, j2) = (first >> 10 & 1, second >> 13 & 1, second >> 11 & 1);
    // S:I1:I2:imm10:imm11:0, I = NOT (J EOR S), A7.7.12 and A7.7.18
    let far = || {
        let high = u32::from(sign) << 2 | u32::from(!(j1 ^ sign) & 1) << 1 | u32::from(!(j2 ^ sign) & 1);
        let offset = high << 22 | u32::from(first & 0x3ff) << 12 | u32::from(second & 0x7ff) << 1;
        target(at, ((offset << 7) as i32) >> 7)
    };
    match (second >> 14 & 1, second >> 12 & 1) {
        (1, 1) => (Flow::Call { target: far() }, Stack::Same),
        (0, 1) => (Flow::Branch { target: far(), conditional: false }, Stack::Same),
        // BLX into the other instruction set, which an M core has not
        (1, _) => UNKNOWN,
        // S:J2:J1:imm6:imm11:0
        _ if first >> 7 & 7 != 7 => {
            let high = u32::from(sign) << 2 | u32::from(j2) << 1 | u32::from(j1);
            let offset = high << 18 | u32::from(first & 0x3f) << 12 | u32::from(second & 0x7ff) << 1;
            (Flow::Branch { target: target(at, ((offset << 11) as i32) >> 11), conditional: true }, Stack::Same)
        }
        _ => match first >> 4 & 0x7f {
            // MSR, B5.2.3: MSP and PSP
            0x38 | 0x39 if matches!(second & 0xff, 8 | 9) => COMPUTED,
            // MSR, hints, barriers, MRS
            0x38..=0x3b | 0x3e | 0x3f => NEXT,
            0x7f if second >> 12 & 7 == 2 => (Flow::Trap, Stack::Same),
            _ => UNKNOWN,
        },
    }
}

/// LDR, STR and the like, A5.3.7 to A5.3.10.
fn single(first: u16, second: u16, base: u16, register: u16) -> (Flow, Stack) {
    // 1111 1001 xxx0: NEON, which an M core has not
    let loads = first & 0x10 != 0;
    if !loads && first & 0x100 != 0 {
        return UNKNOWN;
    }
    let writes_back = first & 0x80 == 0 && second & 0x900 == 0x900 && base != PC;
    let (_, stack) = match writes_back && base == SP {
        true => moved(i32::from(second & 0xff), second & 0x200 != 0),
        false => NEXT,
    };
    let is_word = first & 0x60 == 0x40;
    let flow = match (loads && is_word, register) {
        (true, SP) => return COMPUTED,
        (true, PC) if writes_back && base == SP => Flow::Return,
        (true, PC) => Flow::Unknown,
        _ => Flow::Next,
    };
    (flow, stack)
}

/// The target of a branch at `at`: the program counter reads as the address after next.
fn target(at: u32, offset: i32) -> u32 {
    at.wrapping_add(4).wrapping_add_signed(offset)
}
