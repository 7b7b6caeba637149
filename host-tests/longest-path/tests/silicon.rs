//! Cycles that were measured on silicon, and those of the manuals' examples: each must fall into the interval.
//!
//! The encodings are those that LLVM assembles from the line beside them. Code begins at a multiple of eight.

use driveline_longest_path::Core::{self, M0, M3, M4};
use driveline_longest_path::{Bounds, Code, Cycles, Flash, Loops};

/// The cores, the kernel, its code, the turns of its loop, the cycles.
type Row = (&'static [Core], &'static str, &'static [u16], u64, u64);

const BOTH: &[Core] = &[M3, M4];

/// Sixteen times `nop`; subs r7, #1; bne.
const LOOP_OF_SHORT: [u16; 18] = {
    let mut code = [0xbf00; 18];
    (code[16], code[17]) = (0x3f01, 0xd1ed);
    code
};

/// Seventeen times `nop.w`; subs.w r9, r9, #1; bne.w.
const LOOP_OF_WIDE: [u16; 38] = {
    let mut code = [0x8000; 38];
    let mut at = 0;
    while at < 34 {
        code[at] = 0xf3af;
        at += 2;
    }
    (code[34], code[35], code[36], code[37]) = (0xf1b9, 0x0901, 0xf47f, 0xafda);
    code
};

/// Published figures of "pipeline cycle test" in `jnk0le/random` (CC0): STM32F0 (M0), STM32F103 (M3) and STM32F407 (M4),
/// from memory without wait states. Where it says that something may or may not happen, there is a row for each.
#[rustfmt::skip]
const MEASURED: &[Row] = &[
    (&[M0], "1: 16 times nop; subs r7, #1; bne 1b", &LOOP_OF_SHORT, 1000, 19998),
    (&[M0], "ldr r0, [r1]; adds r0, r0, r2", &[0x6808, 0x1880], 0, 3),
    (&[M0], "lsrs r1, r4, #8; uxtb r1, r1; lsrs r2, r4, #16; uxtb r2, r2", &[0xa21, 0xb2c9, 0xc22, 0xb2d2], 0, 4),
    (&[M0], "rev16 r2, r4; uxtb r1, r2; lsrs r2, r2, #24", &[0xba62, 0xb2d1, 0xe12], 0, 3),
    (BOTH, "1: 17 times nop.w; subs.w r9, r9, #1; bne.w 1b", &LOOP_OF_WIDE, 1000, 20000),
    (BOTH, "1: 17 times nop.w; subs.w r9, r9, #1; bne.w 1b", &LOOP_OF_WIDE, 1, 20),
    (BOTH, "adds r1, r1, r2; ldr r0, [r1]", &[0x1889, 0x6808], 0, 4),
    (BOTH, "adds r2, r2, r3; ldr r0, [r1, r2]", &[0x18d2, 0x5888], 0, 4),
    (BOTH, "adds r1, r1, r2; str r0, [r1]", &[0x1889, 0x6008], 0, 3),
    (BOTH, "adds r2, r2, r3; str r0, [r1, r2]", &[0x18d2, 0x5088], 0, 4),
    (BOTH, "ldr r0, [r1]; ldr r2, [r1, #4]; ldr r3, [r1, #8]; ldr r4, [r1, #12]", &[0x6808, 0x684a, 0x688b, 0x68cc], 0, 5),
    (BOTH, "ldr r0, [r1]; ldr r2, [r3]", &[0x6808, 0x681a], 0, 3),
    (BOTH, "ldr r0, [r1]; ldr r2, [r3]", &[0x6808, 0x681a], 0, 4),
    (BOTH, "mov r7, r7; ldr.w r0, [r1]; ldr.w r2, [r1, #4]; ldr.w r3, [r1, #8]", &[0x463f, 0xf8d1, 0x0, 0xf8d1, 0x2004, 0xf8d1, 0x3008], 0, 5),
    (BOTH, "mov r7, r7; ldr.w r0, [r1]; ldr.w r2, [r1, #4]; ldr.w r3, [r1, #8]", &[0x463f, 0xf8d1, 0x0, 0xf8d1, 0x2004, 0xf8d1, 0x3008], 0, 7),
    (BOTH, "ldr r0, [r1]; nop", &[0x6808, 0xbf00], 0, 2),
    (BOTH, "ldr r0, [r1]; cmp r2, r3", &[0x6808, 0x429a], 0, 3),
    (BOTH, "ldr r0, [r1]; tst r2, r3", &[0x6808, 0x421a], 0, 3),
    (&[M3], "ldr r0, [r1], #4; ldr r2, [r3], #4", &[0xf851, 0xb04, 0xf853, 0x2b04], 0, 4),
    (&[M4], "ldr r0, [r1], #4; ldr r2, [r3], #4", &[0xf851, 0xb04, 0xf853, 0x2b04], 0, 3),
    (BOTH, "ldr r0, [r1], #4; ldr r2, [r1], #4", &[0xf851, 0xb04, 0xf851, 0x2b04], 0, 4),
    (&[M3], "ldr r0, [r1], #4; ldr r2, [r3]", &[0xf851, 0xb04, 0x681a], 0, 3),
    (&[M3], "ldr r2, [r3]; ldr r0, [r1, #4]!", &[0x681a, 0xf851, 0xf04], 0, 4),
    (BOTH, "str r0, [r1]; str r2, [r1, #4]; str r3, [r1, #8]", &[0x6008, 0x604a, 0x608b], 0, 3),
    (BOTH, "mov r7, r7; str r0, [r1], #4", &[0x463f, 0xf841, 0xb04], 0, 2),
    (&[M3], "ldr r2, [r3]; str r0, [r1], #4", &[0x681a, 0xf841, 0xb04], 0, 4),
    (BOTH, "ldr r2, [r1]; str r0, [r1, #4]", &[0x680a, 0x6048], 0, 2),
    (&[M4], "ldr r2, [r3]; str r0, [r1], #4", &[0x681a, 0xf841, 0xb04], 0, 2),
    (BOTH, "str r0, [r1], #4; str r2, [r3], #4", &[0xf841, 0xb04, 0xf843, 0x2b04], 0, 2),
    (BOTH, "str r0, [r1], #4; str r2, [r1], #4", &[0xf841, 0xb04, 0xf841, 0x2b04], 0, 3),
    (BOTH, "str r0, [r1, r2]; adds r3, #1", &[0x5088, 0x3301], 0, 3),
    (BOTH, "str r0, [r1, r2]; mov r3, r4", &[0x5088, 0x4623], 0, 3),
    (BOTH, "str r0, [r1, r2]; nop", &[0x5088, 0xbf00], 0, 2),
    (BOTH, "str r0, [r1]; ldr r2, [r1, #4]", &[0x6008, 0x684a], 0, 4),
    (BOTH, "str r0, [r1]; ldm r5, {r2, r3, r4}", &[0x6008, 0xe895, 0x1c], 0, 6),
    (BOTH, "str r0, [r1]; stm r5!, {r2, r3, r4}", &[0x6008, 0xc51c], 0, 5),
    (BOTH, "ldr r0, [r1]; add.w r2, r3, r4; add.w r3, r4, r5; add.w r4, r5, r6", &[0x6808, 0xeb03, 0x204, 0xeb04, 0x305, 0xeb05, 0x406], 0, 6),
];

/// Measured on an M4 (compendium.i-0.nl, instruction alignment). The first instruction puts those behind it off a word
/// boundary.
#[rustfmt::skip]
const ALIGNMENT: &[Row] = &[
    (&[M4], "mov r7, r7; add.w r2, r3, r4; add.w r2, r3, r4; add.w r2, r3, r4", &[0x463f, 0xeb03, 0x204, 0xeb03, 0x204, 0xeb03, 0x204], 0, 5),
    (&[M4], "mov r7, r7; add.w r2, r3, r4; add.w r2, r3, r4; add.w r2, r3, r4; add.w r2, r3, r4; add.w r2, r3, r4; add.w r2, r3, r4", &[0x463f, 0xeb03, 0x204, 0xeb03, 0x204, 0xeb03, 0x204, 0xeb03, 0x204, 0xeb03, 0x204, 0xeb03, 0x204], 0, 8),
    (&[M4], "mov r7, r7; str.w r0, [r1]; str.w r2, [r1, #4]; str.w r3, [r1, #8]", &[0x463f, 0xf8c1, 0x0, 0xf8c1, 0x2004, 0xf8c1, 0x3008], 0, 4),
    (&[M4], "mov r7, r7; str.w r0, [r1]; str.w r2, [r1, #4]; str.w r3, [r1, #8]; str.w r3, [r1, #12]", &[0x463f, 0xf8c1, 0x0, 0xf8c1, 0x2004, 0xf8c1, 0x3008, 0xf8c1, 0x300c], 0, 6),
    (&[M4], "b 1f; 1: nop", &[0xe7ff, 0xbf00], 0, 3),
    (&[M4], "b 1f; 1: add.w r2, r3, r4", &[0xe7ff, 0xeb03, 0x204], 0, 4),
];

/// Arm DDI 0337I 3-9; DDI 0439D 3-11, 3-12 and tables 3-1 and 7-1 with their notes.
#[rustfmt::skip]
const MANUALS: &[Row] = &[
    (BOTH, "ldr r0, [r1]; ldr r1, [r2]", &[0x6808, 0x6811], 0, 3),
    (BOTH, "ldr r0, [r1, r2]; str r0, [r3, #20]", &[0x5888, 0x6158], 0, 3),
    (BOTH, "ldr r0, [r1, r2]; str r1, [r3, r2]", &[0x5888, 0x5099], 0, 3),
    (BOTH, "ldr r0, [r1, r5]; ldr r1, [r2]; ldr r2, [r3, #4]", &[0x5948, 0x6811, 0x685a], 0, 4),
    (BOTH, "ldr r0, [r1]; ldr r2, [r0]", &[0x6808, 0x6802], 0, 4),
    (BOTH, "add.w r0, r0, r1; ldr r2, [r0]", &[0xeb00, 0x1, 0x6802], 0, 4),
    (BOTH, "mul r0, r0, r1; strb r2, [r0]", &[0xfb00, 0xf001, 0x7002], 0, 3),
    (BOTH, "add.w r0, r0, r1; ldrd r2, r3, [r0]", &[0xeb00, 0x1, 0xe9d0, 0x2300], 0, 5),
    (BOTH, "ldrd r0, r1, [r2]; ldr r3, [r2, #8]", &[0xe9d2, 0x100, 0x6893], 0, 5),
    (BOTH, "stm r0!, {r1, r2, r3, r4, r5, r6, r7}", &[0xc0fe], 0, 8),
    (&[M4], "add.w r0, r0, r1; vldr s0, [r0]", &[0xeb00, 0x1, 0xed90, 0xa00], 0, 4),
    (BOTH, "ldr r0, [pc, #4]", &[0x4801], 0, 2),
    (BOTH, "ldr r0, [pc, #4]", &[0x4801], 0, 3),
    (BOTH, "add.w r0, r0, r1; it eq; addeq r2, r3", &[0xeb00, 0x1, 0xbf08, 0x441a], 0, 3),
    (BOTH, "add r0, r1; it eq; addeq r2, r3", &[0x4408, 0xbf08, 0x441a], 0, 2),
    (&[M4], "vmov r0, s0", &[0xee10, 0xa10], 0, 2),
    (&[M4], "vadd.f32 s0, s1, s2; vadd.f32 s3, s0, s2", &[0xee30, 0xa81, 0xee70, 0x1a01], 0, 3),
    (&[M4], "vadd.f32 s0, s1, s2; vadd.f32 s3, s4, s2", &[0xee30, 0xa81, 0xee72, 0x1a01], 0, 2),
    (&[M4], "vadd.f32 s0, s1, s2; vstr s0, [r0]", &[0xee30, 0xa81, 0xed80, 0xa00], 0, 4),
    (&[M4], "vmul.f32 s0, s1, s2; vmla.f32 s0, s3, s4", &[0xee20, 0xa81, 0xee01, 0xa82], 0, 4),
    (&[M4], "vmul.f32 s3, s1, s2; vmla.f32 s0, s3, s4", &[0xee60, 0x1a81, 0xee01, 0xa82], 0, 5),
    (&[M4], "vmla.f32 s0, s1, s2; vmla.f32 s0, s3, s4; vmul.f32 s5, s0, s0", &[0xee00, 0xa81, 0xee01, 0xa82, 0xee60, 0x2a00], 0, 8),
    (&[M4], "vcvt.f32.s32 s0, s1; vadd.f32 s2, s0, s0", &[0xeeb8, 0xae0, 0xee30, 0x1a00], 0, 3),
    (&[M4], "vdiv.f32 s0, s1, s2", &[0xee80, 0xa81], 0, 1),
    (&[M4], "vdiv.f32 s0, s1, s2", &[0xee80, 0xa81], 0, 14),
];

fn interval(core: Core, code: &[u16], turns: u64) -> Cycles {
    let code = Code::of(0x100, &[("f", code)], &[]);
    let mut loops = Loops::default();
    if turns > 0 {
        loops.state("f", vec![turns]);
    }
    Bounds::cycles(&code, &loops, core, Flash::IDEAL, 0x100).unwrap()
}

#[test]
fn every_measured_kernel_is_within_its_interval() {
    let mut outside = Vec::new();
    for &(cores, text, code, turns, cycles) in [MEASURED, ALIGNMENT, MANUALS].concat().iter() {
        for &core in cores {
            // less the return behind it
            let back = interval(core, &[0x4770], 0);
            let all = interval(core, &[code, &[0x4770]].concat(), turns);
            let found = all.least - back.least..=all.most - back.most;
            if !found.contains(&cycles) {
                outside.push(format!("{text} on {core:?}: {cycles} is not in {found:?}"));
            }
        }
    }
    assert!(outside.is_empty(), "{outside:#?}");
}

/// An interval that covers everything would contain every measurement: these are as narrow as the rules.
#[test]
fn kernels_without_a_choice_have_no_width() {
    let told: [&[u16]; 5] = [
        &[0xeb00, 0x0001, 0x6802],         // add.w r0, r0, r1; ldr r2, [r0]
        &[0x6808, 0x684a, 0x688b, 0x68cc], // four loads behind each other
        &[0x6008, 0x604a, 0x608b],         // three stores
        &[0xee30, 0x0a81, 0xee70, 0x1a01], // vadd.f32 s0, s1, s2; vadd.f32 s3, s0, s2
        &[0xeb00, 0x0001, 0xbf08, 0x441a], // add.w r0, r0, r1; it eq; addeq r2, r3
    ];
    for code in told {
        let (all, back) = (interval(M4, &[code, &[0x4770]].concat(), 0), interval(M4, &[0x4770], 0));
        assert_eq!(all.least - back.least, all.most - back.most, "{code:x?}");
    }
}
