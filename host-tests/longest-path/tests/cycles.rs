//! Cycles of instructions beside the tables of the cores' manuals, and of paths counted by hand.

use driveline_longest_path::{Bounds, Code, Core, Cycles, Flash, Loops, loaded_words};

/// Behind an instruction without effect on it. The encodings are those that LLVM assembles; cycles by Arm DDI 0439, tables 3-1 and 7-1, and DDI 0337, DDI 0484 and
/// DDI 0432, each table 3-1.
#[test]
fn instructions_take_the_cycles_of_the_manuals() {
    let both: [((u16, u16), (u64, u64), &str); 22] = [
        ((0x1840, 0), (1, 1), "adds r0, r0, r1"),
        ((0x6808, 0), (2, 2), "ldr r0, [r1]"),
        ((0x6008, 0), (1, 1), "str r0, [r1]"),
        ((0xf8d0, 0x1004), (2, 2), "ldr.w r1, [r0, #4]"),
        ((0xe9d0, 0x1202), (3, 3), "ldrd r1, r2, [r0, #8]"),
        ((0xb5f0, 0), (6, 6), "push {r4-r7, lr}"),
        ((0xbcf0, 0), (5, 5), "pop {r4-r7}"),
        ((0xbdf0, 0), (7, 9), "pop {r4-r7, pc}"),
        ((0xe92d, 0x4ff0), (10, 10), "push.w {r4-r11, lr}"),
        ((0xe8bd, 0x8ff0), (11, 13), "pop.w {r4-r11, pc}"),
        ((0x4770, 0), (2, 4), "bx lr"),
        ((0xf000, 0xf803), (2, 4), "bl"),
        ((0xe8df, 0xf000), (2, 3), "tbb [pc, r0], the jump apart"),
        ((0xbf08, 0), (1, 1), "it eq"),
        ((0xfb92, 0xf0f1), (2, 12), "sdiv r0, r2, r1"),
        ((0xed90, 0x0a01), (2, 2), "vldr s0, [r0, #4]"),
        ((0xed2d, 0x8b04), (5, 5), "vpush {d8, d9}"),
        ((0xee01, 0x0a02), (3, 3), "vmla.f32 s0, s2, s4"),
        ((0xee31, 0x0a02), (1, 1), "vadd.f32 s0, s2, s4"),
        ((0xee81, 0x0a02), (1, 14), "vdiv.f32 s0, s2, s4"),
        ((0xeeb1, 0x0ac1), (1, 14), "vsqrt.f32 s0, s2"),
        ((0xeef1, 0xfa10), (1, 1), "vmrs APSR_nzcv, fpscr"),
    ];
    for ((first, second), (least, most), text) in both {
        for core in [Core::M3, Core::M4] {
            assert_eq!(Cycles::of(core, first, second), Cycles { least, most }, "{text} on {core:?}");
        }
    }
    let multiplications: [((u16, u16), (u64, u64), &str); 4] = [
        ((0xfb00, 0xf001), (1, 1), "mul r0, r0, r1"),
        ((0xfb00, 0x2001), (2, 2), "mla r0, r0, r1, r2"),
        ((0xfb81, 0x0302), (3, 5), "smull r0, r3, r1, r2"),
        ((0xfbc1, 0x0302), (4, 7), "smlal r0, r3, r1, r2"),
    ];
    for ((first, second), (least, most), text) in multiplications {
        assert_eq!(Cycles::of(Core::M3, first, second), Cycles { least, most }, "{text} on the M3");
        assert_eq!(Cycles::of(Core::M4, first, second), Cycles { least: 1, most: 1 }, "{text} on the M4");
    }
    // cycles of the M0, and least and most of the M0+
    let small: [((u16, u16), u64, (u64, u64), &str); 9] = [
        ((0x1840, 0), 1, (1, 1), "adds r0, r0, r1"),
        ((0x4348, 0), 1, (1, 1), "muls r0, r1, r0 by the fast multiplier"),
        ((0x6808, 0), 2, (1, 2), "ldr r0, [r1]"),
        ((0xc906, 0), 3, (3, 3), "ldm r1!, {r1, r2}"),
        ((0xb5f0, 0), 6, (6, 6), "push {r4-r7, lr}"),
        ((0xbdf0, 0), 9, (8, 8), "pop {r4-r7, pc}"),
        ((0x4770, 0), 3, (2, 2), "bx lr"),
        ((0xf000, 0xf803), 4, (3, 3), "bl"),
        ((0xf3ef, 0x8010), 4, (3, 3), "mrs r0, primask"),
    ];
    for ((first, second), cycles, (least, most), text) in small {
        assert_eq!(Cycles::of(Core::M0, first, second), Cycles { least: cycles, most: cycles }, "{text} on the M0");
        assert_eq!(Cycles::of(Core::M0Plus, first, second), Cycles { least, most }, "{text} on the M0+");
    }
}

fn cycles(code: &[u16], turns: &[u64]) -> (u64, u64) {
    on(Core::M4, Flash::IDEAL, code, turns)
}

/// Least and most of a function at 0x100.
fn on(core: Core, flash: Flash, code: &[u16], turns: &[u64]) -> (u64, u64) {
    let code = Code::of(0x100, &[("f", code)], &[]);
    let mut loops = Loops::default();
    if !turns.is_empty() {
        loops.state("f", turns.to_vec());
    }
    let Cycles { least, most } = Bounds::cycles(&code, &loops, core, flash, 0x100).unwrap();
    (least, most)
}

/// By hand, for three wait states a line of eight bytes.
#[test]
fn code_waits_for_its_flash() {
    let flash = Flash { wait_states: 3, line: 8 };
    // five times nop; bx lr. Twelve bytes are two lines; the return waits twice.
    assert_eq!(
        on(Core::M0, flash, &[0xbf00, 0xbf00, 0xbf00, 0xbf00, 0xbf00, 0x4770], &[]),
        (5 + 3, 5 + 3 + 3 * (2 + 2))
    );
    // ldr r0, [r1]; bx lr: a line, the load and the line again, the return
    assert_eq!(on(Core::M0, flash, &[0x6808, 0x4770], &[]).1, 2 + 3 + 3 * (1 + 2 + 2));
    // movs r1, #0; 1: adds r1, r1, r0; subs r0, #1; bne 1b; bx lr. Two lines; the loop is in the first.
    let turns = 5;
    let jumps = (turns - 1) * (2 + 2 * 3);
    assert_eq!(
        on(Core::M0, flash, &[0x2100, 0x1809, 0x3801, 0xd1fc, 0x4770], &[turns]).1,
        1 + 3 * turns + jumps + 3 + 3 * (2 + 2)
    );
    // on the M3 the branch that is not taken fetches its target, too
    let jumps = (turns - 1) * (2 + 2 * 3) + 1 + 2 * 3;
    assert_eq!(
        on(Core::M3, flash, &[0x2100, 0x1809, 0x3801, 0xd1fc, 0x4770], &[turns]).1,
        1 + 3 * turns + jumps + 4 + 3 * (2 + 2)
    );
    // a wide instruction over the end of a line waits for the next one: nop; nop; nop; movw r0, #0; bx lr
    let across = [0xbf00, 0xbf00, 0xbf00, 0xf240, 0x0000, 0x4770];
    assert_eq!(on(Core::M3, flash, &across, &[]).1, 4 + 4 + 3 * (2 + 2));
}

#[test]
fn loads_are_told_from_stores_and_from_the_stack() {
    let cases: [((u16, u16), u64, &str); 16] = [
        ((0x4801, 0), 1, "ldr r0, [pc, #4]"),
        ((0x5888, 0), 1, "ldr r0, [r1, r2]"),
        ((0x5088, 0), 0, "str r0, [r1, r2]"),
        ((0x5688, 0), 1, "ldrsb r0, [r1, r2]"),
        ((0x9801, 0), 0, "ldr r0, [sp, #4]"),
        ((0xc906, 0), 2, "ldm r1!, {r1, r2}"),
        ((0xc106, 0), 0, "stm r1!, {r1, r2}"),
        ((0xbdf0, 0), 0, "pop {r4-r7, pc}"),
        ((0xe9d0, 0x1202), 2, "ldrd r1, r2, [r0, #8]"),
        ((0xe9dd, 0x1202), 0, "ldrd r1, r2, [sp, #8]"),
        ((0xe8bd, 0x8ff0), 0, "pop.w {r4-r11, pc}"),
        ((0xe890, 0x0ff0), 8, "ldm.w r0, {r4-r11}"),
        ((0xed90, 0x0a01), 1, "vldr s0, [r0, #4]"),
        ((0xed80, 0x0a01), 0, "vstr s0, [r0, #4]"),
        ((0xec90, 0x0a04), 4, "vldmia r0, {s0-s3}"),
        ((0xec51, 0x0a10), 0, "vmov r0, r1, s0, s1"),
    ];
    for ((first, second), words, text) in cases {
        assert_eq!(loaded_words(first, second), words, "{text}");
    }
}

/// `movw r0, #0` is no instruction of Armv6-M, `cbz` neither; `vadd.f32 s0, s2, s4` none of a core without the unit.
#[test]
fn an_instruction_of_another_core_is_refused() {
    let refused = |core, code: &[u16]| {
        let code = Code::of(0x100, &[("f", code)], &[]);
        Bounds::cycles(&code, &Loops::default(), core, Flash::IDEAL, 0x100).is_err()
    };
    let movw: &[u16] = &[0xf240, 0x0000, 0x4770];
    let cbz: &[u16] = &[0xb100, 0x4770, 0x4770];
    let vadd: &[u16] = &[0xee31, 0x0a02, 0x4770];
    for (code, cores) in
        [(movw, [true, true, false, false]), (cbz, [true, true, false, false]), (vadd, [true, true, true, false])]
    {
        let found = [Core::M0, Core::M0Plus, Core::M3, Core::M4].map(|core| refused(core, code));
        assert_eq!(found, cores, "{code:x?}");
    }
    // mrs r0, primask; dmb; bx lr
    assert!(!refused(Core::M0Plus, &[0xf3ef, 0x8010, 0xf3bf, 0x8f5f, 0x4770]));
}

#[test]
fn a_branch_takes_longer_where_it_is_taken() {
    // cbz r0, 1f; four times nop; bx lr; 1: bx lr. Not taken: 1 + 4 + 1 + P, of most cycles; taken: 1 + P + 1 + P.
    assert_eq!(cycles(&[0xb120, 0xbf00, 0xbf00, 0xbf00, 0xbf00, 0x4770, 0x4770], &[]), (1 + 4 + 2, 1 + 4 + 4));
    // cbz r0, 1f; bx lr; 1: bx lr. The path with the most cycles is the one that jumps.
    assert_eq!(cycles(&[0xb100, 0x4770, 0x4770], &[]), (1 + 1 + 2, 1 + 3 + 4));
}

/// At least six by the text of both manuals (DDI 0337I 3-9, DDI 0439D 3-12), 2 + P by their tables, and one where the
/// table is fetched against the code.
#[test]
fn a_jump_through_a_table_takes_six() {
    // tbh [pc, r0, lsl #1]; .short to 6, 7; 6: bx lr; 7: nop; bx lr
    let code = Code::of(0x100, &[("f", &[0xe8df, 0xf010, 2, 3, 0x4770, 0xbf00, 0x4770])], &[(0x104, 0x108)]);
    for core in [Core::M3, Core::M4] {
        let found = Bounds::cycles(&code, &Loops::default(), core, Flash::IDEAL, 0x100).unwrap();
        assert_eq!(found, Cycles { least: (2 + 1) + 1 + 2, most: (6 + 1) + 1 + 4 }, "{core:?}");
    }
}

#[test]
fn a_loop_jumps_in_every_turn_but_the_last() {
    // movs r1, #0; 1: adds r1, r1, r0; subs r0, #1; bne 1b; bx lr
    assert_eq!(cycles(&[0x2100, 0x1809, 0x3801, 0xd1fc, 0x4770], &[5]).1, 1 + 5 * 3 + 4 * 2 + 1 + 4);
}

#[test]
fn a_skipped_instruction_takes_one_cycle_at_least() {
    // it eq; vdiveq.f32 s0, s2, s4; bx lr
    assert_eq!(cycles(&[0xbf08, 0xee81, 0x0a02, 0x4770], &[]), (1 + 2, 1 + 14 + 4));
}

#[test]
fn a_call_is_taken_and_so_is_a_jump_into_another_function() {
    // push {r4, lr}; bl callee; pop.w {r4, lr}; b callee. Behind it: nop; bx lr.
    let functions: [(&str, &[u16]); 2] =
        [("caller", &[0xb510, 0xf000, 0xf803, 0xe8bd, 0x4010, 0xe7ff]), ("callee", &[0xbf00, 0x4770])];
    let loops = Loops::default();
    let found = Bounds::cycles(&Code::of(0x100, &functions, &[]), &loops, Core::M3, Flash::IDEAL, 0x100).unwrap();
    let callee = (3, 5);
    assert_eq!(found, Cycles { least: 3 + 2 + callee.0 + 3 + 2 + callee.0, most: 3 + 4 + callee.1 + 3 + 4 + callee.1 });
}
