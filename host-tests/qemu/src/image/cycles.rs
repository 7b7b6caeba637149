//! An estimate of a tick's cycles from its instruction mix. QEMU counts instructions, not cycles; this is arithmetic on
//! tables.
//!
//! Cycles by kind of instruction are those of the cores' technical reference manuals (Arm DDI 0439 for the Cortex-M4,
//! DDI 0337 for the Cortex-M3), without wait states: a load 2, several registers 1 and one each, a taken branch 2, VMLA
//! 3, VDIV and VSQRT 14, a long multiplication 1 on the M4 and 4 to 5 on the M3, where it depends on the operands.

use std::error::Error;
use std::fs;

use object::Endianness;
use object::read::elf::ElfFile32;

use super::{Contents, Image, Symbol, calls};

/// Cycles of `instructions` instructions with the mean cycles of the tick's code.
///
/// # Errors
/// A file that cannot be read, or that has no tick.
pub fn estimate(image: &Image, instructions: u32) -> Result<u64, Box<dyn Error>> {
    let bytes = fs::read(&image.path)?;
    let file = ElfFile32::<Endianness>::parse(&*bytes)?;
    let contents = Contents::read(&image.path)?;
    let slow_multiplier = image.board.core == "m3";
    let (mut cycles, mut count) = (0, 0);
    for symbol in calls::reached(&file, &contents.symbols, "driveline_tick") {
        for (first, second) in decode(&file, symbol) {
            cycles += u64::from(cost(first, second, slow_multiplier));
            count += 1;
        }
    }
    if count == 0 {
        return Err(format!("{} has no tick", image.path.display()).into());
    }
    Ok((u64::from(instructions) * cycles + count / 2) / count)
}

/// The instructions of a function as halfwords, the second zero in a short one. Constants among the code are left out.
fn decode(file: &ElfFile32<'_>, function: &Symbol) -> Vec<(u16, u16)> {
    let constants = calls::constants(file, function);
    let (mut at, mut instructions) = (function.address, Vec::new());
    while at < function.address + function.size {
        if let Some(&(_, after)) = constants.iter().find(|&&(start, after)| (start..after).contains(&at)) {
            at = after;
            continue;
        }
        let Some(first) = calls::halfword(file, at) else { break };
        let long = first >> 11 >= 0b11101;
        instructions.push((first, if long { calls::halfword(file, at + 2).unwrap_or(0) } else { 0 }));
        at += if long { 4 } else { 2 };
    }
    instructions
}

/// Cycles of one instruction, by its encoding [Arm DDI 0403 §A5].
fn cost(first: u16, second: u16, slow_multiplier: bool) -> u32 {
    if first >> 11 >= 0b11101 { long(first, second, slow_multiplier) } else { short(first) }
}

fn short(word: u16) -> u32 {
    let registers = (word & 0xff).count_ones() + u32::from(word >> 8 & 1);
    match word >> 9 {
        0b101_1010 => return 1 + registers,                                // PUSH
        0b101_1110 => return 1 + registers + 2 * u32::from(word >> 8 & 1), // POP, with a jump
        _ => {}
    }
    match word >> 11 {
        0b01001 => 2,                                         // LDR, literal
        0b01010 if word >> 9 & 3 == 3 => 2,                   // STR, STRH, STRB, LDRSB
        0b01011 | 0b01101 | 0b01111 | 0b10001 | 0b10011 => 2, // LDR and its like
        0b11000 | 0b11001 => 1 + (word & 0xff).count_ones(),  // STM, LDM
        0b11010..=0b11100 => 2,                               // B
        0b10110 | 0b10111 if word & 0xf500 == 0xb100 => 2,    // CBZ, CBNZ
        _ if word & 0xff00 == 0x4700 => 3,                    // BX, BLX
        _ => 1,
    }
}

fn long(first: u16, second: u16, slow_multiplier: bool) -> u32 {
    match first {
        _ if first & 0xffd0 == 0xfb80 && slow_multiplier => 4, // SMULL, UMULL
        _ if first & 0xffd0 == 0xfb90 => 7,                    // SDIV, UDIV: 2 to 12
        _ if first & 0xffd0 == 0xfbc0 && slow_multiplier => 5, // SMLAL, UMLAL
        _ if first & 0xff80 == 0xfb00 && second & 0xf000 != 0xf000 && slow_multiplier => 2, // MLA, MLS
        _ if first & 0xfe40 == 0xe800 => 1 + second.count_ones(), // LDM, STM
        _ if first & 0xfe50 == 0xe850 => 3,                    // LDRD
        _ if first & 0xfe50 == 0xe840 => 2,                    // STRD
        _ if first & 0xfe10 == 0xf810 => 2,                    // LDR and its like
        _ if first & 0xf800 == 0xf000 && second & 0xc000 == 0xc000 => 3, // BL
        _ if first & 0xf800 == 0xf000 && second & 0xc000 == 0x8000 => 2, // B
        _ if first & 0xff30 == 0xed10 => 2,                    // VLDR
        _ if first & 0xff30 == 0xed00 => 1,                    // VSTR
        _ if first & 0xfe00 == 0xec00 => 1 + u32::from(second & 0xff), // VLDM, VSTM, VPUSH, VPOP
        _ if first & 0xffb0 == 0xee00 && second & 0x10 == 0 => 3, // VMLA, VMLS
        _ if first & 0xffb0 == 0xee10 && second & 0x10 == 0 => 3, // VNMLA, VNMLS
        _ if first & 0xffb0 == 0xee80 && second & 0x10 == 0 => 14, // VDIV
        _ if first & 0xffbf == 0xeeb1 && second & 0xd0 == 0xc0 => 14, // VSQRT
        _ => 1,
    }
}

#[cfg(test)]
mod tests {
    use super::cost;

    /// Encodings from the Arm architecture reference manual, as an assembler gives them; cycles from the cores'
    /// manuals.
    #[test]
    fn instructions_cost_what_the_manuals_say() {
        let cases = [
            ((0xb5f0, 0), 1 + 5, "push {r4-r7, lr}"),
            ((0xbdf0, 0), 1 + 5 + 2, "pop {r4-r7, pc}"),
            ((0x6808, 0), 2, "ldr r0, [r1]"),
            ((0x6008, 0), 1, "str r0, [r1]"),
            ((0x1840, 0), 1, "adds r0, r0, r1"),
            ((0xd0fe, 0), 2, "beq"),
            ((0xfb81, 0x0302), 1, "smull r0, r3, r1, r2"),
            ((0xfbc1, 0x0302), 1, "smlal r0, r3, r1, r2"),
            ((0xe9d0, 0x1202), 3, "ldrd r1, r2, [r0, #8]"),
            ((0xed90, 0x0a01), 2, "vldr s0, [r0, #4]"),
            ((0xed80, 0x0a01), 1, "vstr s0, [r0, #4]"),
            ((0xee01, 0x0a02), 3, "vmla.f32 s0, s2, s4"),
            ((0xee31, 0x0a02), 1, "vadd.f32 s0, s2, s4"),
            ((0xee81, 0x0a02), 14, "vdiv.f32 s0, s2, s4"),
            ((0xeeb1, 0x0ac1), 14, "vsqrt.f32 s0, s2"),
        ];
        for ((first, second), cycles, text) in cases {
            assert_eq!(cost(first, second, false), cycles, "{text}");
        }
        assert_eq!(cost(0xfb81, 0x0302, true), 4, "smull on the M3");
    }
}
