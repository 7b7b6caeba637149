//! Bounds of short functions, counted by hand. The code is what LLVM assembles from the lines beside it; instructions
//! that `IT` skips count, as QEMU counts them.

use driveline_longest_path::{Bound, Bounds, Code, Loops, Piece, Refusal};

/// Where the code of each test begins.
const START: u32 = 0x100;

/// The bound of a function alone, with the turns of its loops.
fn bound(code: &[u16], turns: &[u64], constants: &[(u32, u32)]) -> Result<Bound, Refusal> {
    let mut loops = Loops::default();
    if !turns.is_empty() {
        loops.state("f", turns.to_vec());
    }
    Bounds::new(&Code::of(START, &[("f", code)], constants), &loops).of(START)
}

fn instructions(code: &[u16]) -> u64 {
    bound(code, &[], &[]).unwrap().instructions
}

#[test]
fn a_straight_line_is_its_length() {
    // push {r4, lr}; adds r0, r0, r1; pop {r4, pc}
    assert_eq!(bound(&[0xb510, 0x1840, 0xbd10], &[], &[]), Ok(Bound { instructions: 3, stack: 8 }));
}

#[test]
fn of_two_branches_the_longer_counts() {
    // cmp r0, #0; beq 1f; adds r0, #1; adds r0, #2; adds r0, #3; bx lr; 1: bx lr
    assert_eq!(instructions(&[0x2800, 0xd003, 0x3001, 0x3002, 0x3003, 0x4770, 0x4770]), 6);
    // beq.w 1f; b.w 2f; 1: nop; 2: bx lr
    assert_eq!(instructions(&[0xf000, 0x8002, 0xf000, 0xb801, 0xbf00, 0x4770]), 3);
}

#[test]
fn skipped_instructions_of_an_it_block_count() {
    // cmp r0, #0; itte ne; addne r0, #1; addne r0, #2; moveq r0, #3; bx lr
    assert_eq!(instructions(&[0x2800, 0xbf1a, 0x3001, 0x3002, 0x2003, 0x4770]), 6);
}

#[test]
fn a_return_on_a_condition_is_taken_or_not() {
    // push {r4, lr}; cmp r0, #0; it eq; popeq {r4, pc}; adds r0, #1; pop {r4, pc}
    let code = [0xb510, 0x2800, 0xbf08, 0xbd10, 0x3001, 0xbd10];
    assert_eq!(bound(&code, &[], &[]), Ok(Bound { instructions: 6, stack: 8 }));
}

#[test]
fn a_trap_ends_a_path() {
    // cbz r0, 1f; bx lr; 1: udf #254
    assert_eq!(instructions(&[0xb100, 0x4770, 0xdefe]), 2);
}

/// movs r1, #0; 1: adds r1, r1, r0; subs r0, #1; bne 1b; bx lr
const LOOP: [u16; 5] = [0x2100, 0x1809, 0x3801, 0xd1fc, 0x4770];

#[test]
fn a_loop_counts_as_often_as_it_turns() {
    for turns in 1..6 {
        assert_eq!(bound(&LOOP, &[turns], &[]).unwrap().instructions, 1 + 3 * turns + 1, "{turns}");
    }
}

#[test]
fn a_loop_in_a_loop_turns_in_each_of_its_turns() {
    // movs r1, #3; 1: movs r2, #2; 2: subs r2, #1; bne 2b; subs r1, #1; bne 1b; bx lr
    let code = [0x2103, 0x2202, 0x3a01, 0xd1fd, 0x3901, 0xd1fa, 0x4770];
    assert_eq!(bound(&code, &[3, 2], &[]).unwrap().instructions, 1 + 3 * (1 + 2 * 2 + 2) + 1);
}

#[test]
fn a_loop_needs_its_turns_stated() {
    let at = START + 2;
    assert_eq!(bound(&LOOP, &[], &[]), Err(Refusal::Loop { function: "f".into(), at, index: 0 }));
    let more = Refusal::NoSuchLoop { function: "f".into(), found: 1, stated: 2 };
    assert_eq!(bound(&LOOP, &[3, 3], &[]), Err(more));
}

#[test]
fn a_loop_with_two_entries_is_refused() {
    // cbz r0, 2f; 1: subs r0, #1; 2: subs r0, #1; bne 1b; bx lr
    let refused = bound(&[0xb100, 0x3801, 0x3801, 0xd1fc, 0x4770], &[], &[]);
    assert!(matches!(refused, Err(Refusal::Irreducible { .. })), "{refused:?}");
}

#[test]
fn every_entry_of_a_jump_table_is_followed() {
    // cmp r0, #2; bhi 9f; tbb [pc, r0]; 5: .byte to 6, 7, 8, and one to fill;
    // 6: bx lr; 7: nop; bx lr; 8: nop; nop; bx lr; 9: bx lr
    let table = [0x2802, 0xd809, 0xe8df, 0xf000, 0x0302, 0x0005];
    let code = [&table[..], &[0x4770, 0xbf00, 0x4770, 0xbf00, 0xbf00, 0x4770, 0x4770]].concat();
    let constants = [(START + 8, START + 12)];
    assert_eq!(bound(&code, &[], &constants).unwrap().instructions, 6);
    // without its end the table cannot be read
    let at = START + 4;
    assert_eq!(bound(&code, &[], &[]), Err(Refusal::NoCode { function: "f".into(), at }));
    // tbh [pc, r0, lsl #1]; .short to 6, 7; 6: bx lr; 7: nop; bx lr
    let code = [0xe8df, 0xf010, 2, 3, 0x4770, 0xbf00, 0x4770];
    assert_eq!(bound(&code, &[], &[(START + 4, START + 8)]).unwrap().instructions, 3);
    // the same with zeros and nops up to where a loop is aligned; one between the entries is none of these
    for filled in [[0, 0], [0xbf00, 0], [0xbf00, 0xbf00]] {
        let code = [&[0xe8df, 0xf010, 4, 5][..], &filled, &[0x4770, 0xbf00, 0x4770]].concat();
        assert_eq!(bound(&code, &[], &[(START + 4, START + 12)]).unwrap().instructions, 3);
    }
    let code = [0xe8df, 0xf010, 4, 0, 5, 0, 0x4770, 0xbf00, 0x4770];
    let refused = bound(&code, &[], &[(START + 4, START + 12)]);
    assert_eq!(refused, Err(Refusal::NoCode { function: "f".into(), at: START + 4 }));
}

#[test]
fn the_stack_is_the_deepest_of_every_form() {
    // vpush {d8, d9}; sub sp, #24; sub.w sp, sp, #256; subw sp, sp, #1028; vldr s0, [r0]; vmla.f32 s0, s1, s2;
    // vcmp.f32 s0, #0; vmrs APSR_nzcv, fpscr; addw sp, sp, #1028; add.w sp, sp, #256; add sp, #24; vpop {d8, d9}; bx lr
    let float = [
        0xed2d, 0x8b04, 0xb086, 0xf5ad, 0x7d80, 0xf2ad, 0x4d04, 0xed90, 0x0a00, 0xee00, 0x0a81, 0xeeb5, 0x0a40, 0xeef1,
        0xfa10, 0xf20d, 0x4d04, 0xf50d, 0x7d80, 0xb006, 0xecbd, 0x8b04, 0x4770,
    ];
    assert_eq!(bound(&float, &[], &[]), Ok(Bound { instructions: 13, stack: 16 + 24 + 256 + 1028 }));
    // str r0, [sp, #-8]!; strd r0, r1, [sp, #-16]!; push.w {r4-r11, lr}; smlad r0, r1, r2, r3; qadd r0, r1, r2;
    // pop.w {r4-r11, lr}; ldrd r0, r1, [sp], #16; ldr pc, [sp], #8
    let stored = [
        0xf84d, 0x0d08, 0xe96d, 0x0104, 0xe92d, 0x4ff0, 0xfb21, 0x3002, 0xfa82, 0xf081, 0xe8bd, 0x4ff0, 0xe8fd, 0x0104,
        0xf85d, 0xfb08,
    ];
    assert_eq!(bound(&stored, &[], &[]), Ok(Bound { instructions: 8, stack: 8 + 16 + 36 }));
}

#[test]
fn a_stack_that_is_not_known_is_refused() {
    let cases: [(&str, &[u16]); 4] = [
        ("mov sp, r0; bx lr", &[0x4685, 0x4770]),
        ("1: push {r0}; subs r0, #1; bne 1b; bx lr", &[0xb401, 0x3801, 0xd1fc, 0x4770]),
        ("it ne; pushne {r0}; bx lr", &[0xbf18, 0xb401, 0x4770]),
        ("push {r0}; bx lr", &[0xb401, 0x4770]),
    ];
    for (text, code) in cases {
        let refused = bound(code, &[1], &[]);
        assert!(matches!(refused, Err(Refusal::Stack { .. })), "{text}: {refused:?}");
    }
}

#[test]
fn a_computed_address_is_refused() {
    let cases: [(&str, &[u16]); 4] = [
        ("blx r3; bx lr", &[0x4798, 0x4770]),
        ("bx r3", &[0x4718]),
        ("mov pc, r3", &[0x469f]),
        ("ldr.w pc, [r0]", &[0xf8d0, 0xf000]),
    ];
    for (text, code) in cases {
        assert_eq!(bound(code, &[], &[]), Err(Refusal::Indirect { function: "f".into(), at: START }), "{text}");
    }
}

/// `caller` at 0x100: push {r4, lr}; bl callee; pop.w {r4, lr}; b callee. `callee` behind it: push {r4-r7}; nop;
/// pop {r4-r7}; bx lr.
const CALLS: [(&str, &[u16]); 2] =
    [("caller", &[0xb510, 0xf000, 0xf803, 0xe8bd, 0x4010, 0xe7ff]), ("callee", &[0xb4f0, 0xbf00, 0xbcf0, 0x4770])];

#[test]
fn a_callee_counts_at_each_call_and_its_stack_below_the_callers() {
    let code = Code::of(START, &CALLS, &[]);
    let loops = Loops::default();
    let mut bounds = Bounds::new(&code, &loops);
    let callee = code.named("callee").unwrap().start;
    assert_eq!(bounds.of(callee), Ok(Bound { instructions: 4, stack: 16 }));
    // the second call is a jump, after the caller's own stack is given back
    assert_eq!(bounds.of(START), Ok(Bound { instructions: 4 + 2 * 4, stack: 8 + 16 }));
}

#[test]
fn the_path_lists_the_instructions_of_the_bound() {
    let code = Code::of(START, &CALLS, &[]);
    let loops = Loops::default();
    let path = Bounds::new(&code, &loops).path(START).unwrap();
    let piece = |function: &str, depth, from, to, instructions| Piece {
        function: function.into(),
        depth,
        from,
        to,
        instructions,
        times: 1,
    };
    let callee = || piece("callee", 1, 0x10c, 0x114, 4);
    let caller = |from, to| piece("caller", 0, from, to, 2);
    assert_eq!(path, [caller(0x100, 0x106), callee(), caller(0x106, 0x10c), callee()]);
}

#[test]
fn the_path_of_a_loop_lists_its_turns() {
    let code = Code::of(START, &[("f", &LOOP)], &[]);
    let mut loops = Loops::default();
    loops.state("f", vec![5]);
    let mut bounds = Bounds::new(&code, &loops);
    let path = bounds.path(START).unwrap();
    let sum: u64 = path.iter().map(|piece| piece.instructions * piece.times).sum();
    assert_eq!(sum, bounds.of(START).unwrap().instructions);
    assert_eq!(path.iter().map(|piece| piece.times).max(), Some(4), "four turns, and a last one");
}

#[test]
fn recursion_is_refused() {
    // push {r4, lr}; bl f; pop {r4, pc}
    let alone = bound(&[0xb510, 0xf7ff, 0xfffd, 0xbd10], &[], &[]);
    assert_eq!(alone, Err(Refusal::Recursion { function: "f".into(), at: START + 2 }));
    // each calls the other: push {r4, lr}; bl; pop {r4, pc}
    let two: [(&str, &[u16]); 2] = [("f", &[0xb510, 0xf000, 0xf801, 0xbd10]), ("g", &[0xb510, 0xf7ff, 0xfff9, 0xbd10])];
    let loops = Loops::default();
    let refused = Bounds::new(&Code::of(START, &two, &[]), &loops).of(START);
    assert_eq!(refused, Err(Refusal::Recursion { function: "g".into(), at: START + 10 }));
}

#[test]
fn a_branch_into_another_function_is_refused() {
    // b to the second instruction of the function behind
    let two: [(&str, &[u16]); 2] = [("f", &[0xe000, 0x4770]), ("g", &[0xbf00, 0x4770])];
    let loops = Loops::default();
    let code = Code::of(START, &two, &[]);
    assert_eq!(Bounds::new(&code, &loops).of(START).map(|bound| bound.instructions), Ok(3));
    let two: [(&str, &[u16]); 2] = [("f", &[0xe001, 0x4770]), ("g", &[0xbf00, 0x4770])];
    let refused = Bounds::new(&Code::of(START, &two, &[]), &loops).of(START);
    assert_eq!(refused, Err(Refusal::IntoFunction { function: "f".into(), at: START, target: START + 6 }));
}
