//! Which functions a function calls, read from its Thumb code.
//!
//! Branches with a target in the instruction: `BL`, `B.W` and `B` (Arm DDI 0403E, A7.7.12 and A7.7.18). The mapping
//! symbols `$t` and `$d` (Arm IHI 0044, 5.5.5) separate code from the constants in it. Calls through a pointer are not
//! followed; a tick has none.

use std::collections::BTreeSet;

use object::read::elf::ElfFile32;
use object::{Object, ObjectSection, ObjectSymbol};

use super::symbols::Symbol;

/// The function of that name and all that it reaches, each once; empty where there is none of that name.
pub fn reached<'s>(file: &ElfFile32<'_>, symbols: &'s [Symbol], name: &str) -> Vec<&'s Symbol> {
    let functions: Vec<_> = symbols.iter().filter(|symbol| symbol.is_function).collect();
    let mut found: Vec<_> = functions.iter().copied().find(|symbol| symbol.name == name).into_iter().collect();
    let mut seen: BTreeSet<_> = found.iter().map(|symbol| symbol.address).collect();
    let mut next = 0;
    while let Some(&function) = found.get(next) {
        next += 1;
        for target in branches(file, function) {
            // aliases share an address; the first stands for all
            let called = functions.iter().find(|symbol| symbol.address == target);
            if let Some(&called) = called.filter(|_| seen.insert(target)) {
                found.push(called);
            }
        }
    }
    found
}

/// Targets of the branches in a function's code.
fn branches(file: &ElfFile32<'_>, function: &Symbol) -> Vec<u64> {
    let constants = constants(file, function);
    let mut targets = Vec::new();
    let mut at = function.address;
    let end = function.address + function.size;
    while at < end {
        if let Some(&(_, after)) = constants.iter().find(|&&(start, after)| (start..after).contains(&at)) {
            at = after;
            continue;
        }
        let Some(first) = halfword(file, at) else {
            break;
        };
        let is_wide = first >> 11 >= 0b11101;
        let second = if is_wide { halfword(file, at + 2) } else { Some(0) };
        let Some(second) = second else {
            break;
        };
        targets.extend(target(at, first, second));
        at += if is_wide { 4 } else { 2 };
    }
    targets
}

/// The target of the instruction at `at`, where it is a branch; `second` is not looked at where it has one halfword.
pub(super) fn target(at: u64, first: u16, second: u16) -> Option<u64> {
    match first >> 11 {
        0b11100 => Some(offset(at, i64::from(first & 0x7ff) << 1, 12)),
        // BL: 11x1 in the second half's top, B.W: 10x1
        0b11110 if matches!(second & 0xd000, 0xd000 | 0x9000) => {
            Some(offset(at, wide(i64::from(first), i64::from(second)), 25))
        }
        _ => None,
    }
}

/// S:I1:I2:imm10:imm11:0 of a wide branch, with I = NOT (J EOR S).
fn wide(first: i64, second: i64) -> i64 {
    let sign = first >> 10 & 1;
    let i1 = !(second >> 13 ^ sign) & 1;
    let i2 = !(second >> 11 ^ sign) & 1;
    sign << 24 | i1 << 23 | i2 << 22 | (first & 0x3ff) << 12 | (second & 0x7ff) << 1
}

/// The target of a branch at `at` whose offset from the next-but-one halfword is a signed number of `bits`.
fn offset(at: u64, unsigned: i64, bits: u32) -> u64 {
    let signed = unsigned << (64 - bits) >> (64 - bits);
    at.wrapping_add(4).wrapping_add_signed(signed)
}

pub(super) fn halfword(file: &ElfFile32<'_>, address: u64) -> Option<u16> {
    let section = file.sections().find(|s| (s.address()..s.address() + s.size()).contains(&address))?;
    let bytes = section.data_range(address, 2).ok()??;
    Some(u16::from_le_bytes([bytes[0], bytes[1]]))
}

/// The ranges of constants within a function.
pub(super) fn constants(file: &ElfFile32<'_>, function: &Symbol) -> Vec<(u64, u64)> {
    let end = function.address + function.size;
    let mut marks: Vec<_> = file
        .symbols()
        .filter(|symbol| (function.address..end).contains(&symbol.address()))
        .filter_map(|symbol| match symbol.name().ok()?.get(..2)? {
            "$d" => Some((symbol.address(), true)),
            "$t" => Some((symbol.address(), false)),
            _ => None,
        })
        .collect();
    marks.sort_unstable();
    marks.dedup();
    let ends = marks.iter().skip(1).map(|&(address, _)| address).chain([end]);
    marks.iter().zip(ends).filter(|((_, is_data), _)| *is_data).map(|(&(start, _), end)| (start, end)).collect()
}
