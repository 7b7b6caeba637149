//! Cycles of instructions beside the tables of the cores' manuals, and of paths counted by hand.

use driveline_longest_path::{Bounds, Code, Core, Cycles, Loops};

/// The encodings are those that LLVM assembles; cycles by Arm DDI 0439, tables 3-1 and 7-1, and DDI 0337, table 3-1.
#[test]
fn instructions_take_the_cycles_of_the_manuals() {
    let both: [((u16, u16), (u64, u64), &str); 22] = [
        ((0x1840, 0), (1, 1), "adds r0, r0, r1"),
        ((0x6808, 0), (1, 2), "ldr r0, [r1]"),
        ((0x6008, 0), (1, 2), "str r0, [r1]"),
        ((0xf8d0, 0x1004), (1, 2), "ldr.w r1, [r0, #4]"),
        ((0xe9d0, 0x1202), (3, 3), "ldrd r1, r2, [r0, #8]"),
        ((0xb5f0, 0), (6, 6), "push {r4-r7, lr}"),
        ((0xbcf0, 0), (5, 5), "pop {r4-r7}"),
        ((0xbdf0, 0), (7, 9), "pop {r4-r7, pc}"),
        ((0xe92d, 0x4ff0), (10, 10), "push.w {r4-r11, lr}"),
        ((0xe8bd, 0x8ff0), (11, 13), "pop.w {r4-r11, pc}"),
        ((0x4770, 0), (2, 4), "bx lr"),
        ((0xf000, 0xf803), (2, 4), "bl"),
        ((0xe8df, 0xf000), (2, 2), "tbb [pc, r0], the jump apart"),
        ((0xbf08, 0), (0, 1), "it eq"),
        ((0xfb92, 0xf0f1), (2, 12), "sdiv r0, r2, r1"),
        ((0xed90, 0x0a01), (2, 2), "vldr s0, [r0, #4]"),
        ((0xed2d, 0x8b04), (5, 5), "vpush {d8, d9}"),
        ((0xee01, 0x0a02), (3, 4), "vmla.f32 s0, s2, s4"),
        ((0xee31, 0x0a02), (1, 2), "vadd.f32 s0, s2, s4"),
        ((0xee81, 0x0a02), (14, 15), "vdiv.f32 s0, s2, s4"),
        ((0xeeb1, 0x0ac1), (14, 15), "vsqrt.f32 s0, s2"),
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
}

fn cycles(code: &[u16], turns: &[u64]) -> (u64, u64) {
    let code = Code::of(0x100, &[("f", code)], &[]);
    let mut loops = Loops::default();
    if !turns.is_empty() {
        loops.state("f", turns.to_vec());
    }
    let Cycles { least, most } = Bounds::cycles(&code, &loops, Core::M4, 0x100).unwrap();
    (least, most)
}

#[test]
fn a_branch_takes_longer_where_it_is_taken() {
    // cbz r0, 1f; four times nop; bx lr; 1: bx lr. Not taken: 1 + 4 + 1 + P, of most cycles; taken: 1 + P + 1 + P.
    assert_eq!(cycles(&[0xb120, 0xbf00, 0xbf00, 0xbf00, 0xbf00, 0x4770, 0x4770], &[]), (1 + 4 + 2, 1 + 4 + 4));
    // cbz r0, 1f; bx lr; 1: bx lr. The path with the most cycles is the one that jumps.
    assert_eq!(cycles(&[0xb100, 0x4770, 0x4770], &[]), (1 + 1 + 2, 1 + 3 + 4));
}

#[test]
fn a_loop_jumps_in_every_turn_but_the_last() {
    // movs r1, #0; 1: adds r1, r1, r0; subs r0, #1; bne 1b; bx lr
    assert_eq!(cycles(&[0x2100, 0x1809, 0x3801, 0xd1fc, 0x4770], &[5]).1, 1 + 5 * 3 + 4 * 3 + 4);
}

#[test]
fn a_skipped_instruction_takes_one_cycle_at_least() {
    // it eq; vdiveq.f32 s0, s2, s4; bx lr
    assert_eq!(cycles(&[0xbf08, 0xee81, 0x0a02, 0x4770], &[]), (1 + 2, 1 + 15 + 4));
}

#[test]
fn a_call_is_taken_and_so_is_a_jump_into_another_function() {
    // push {r4, lr}; bl callee; pop.w {r4, lr}; b callee. Behind it: nop; bx lr.
    let functions: [(&str, &[u16]); 2] =
        [("caller", &[0xb510, 0xf000, 0xf803, 0xe8bd, 0x4010, 0xe7ff]), ("callee", &[0xbf00, 0x4770])];
    let loops = Loops::default();
    let found = Bounds::cycles(&Code::of(0x100, &functions, &[]), &loops, Core::M3, 0x100).unwrap();
    let callee = (3, 5);
    assert_eq!(found, Cycles { least: 3 + 2 + callee.0 + 3 + 2 + callee.0, most: 3 + 4 + callee.1 + 3 + 4 + callee.1 });
}
