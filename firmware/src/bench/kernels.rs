//! Kernels: one instruction many times over, so that a board's cycles can be laid beside the rules for it.
//!
//! Each is a straight line: the machine code has one path, and in QEMU the count is that path's to the instruction.
//! Where time depends on operands there is a kernel with small and one with large ones. Armv7-M; `cargo driveline
//! longest-path --counted` compares.

use core::arch::asm;

use super::Bench;
use crate::board::Board;

/// Memory that kernels load from and store to.
type Memory = [u32; 8];

/// A function of some lines of assembly, which may use r1 to r3, r12, s0 to s3, and the memory at r0.
macro_rules! kernel {
    ($name:ident: $($line:literal),+) => {
        #[inline(never)]
        fn $name(memory: &mut Memory, _: &(), _: &mut ()) {
            // SAFETY: within the memory; the stack is left as it was; the registers are named.
            unsafe {
                asm!(
                    $($line),+,
                    inout("r0") memory => _, out("r1") _, out("r2") _, out("r3") _, out("r12") _, out("lr") _,
                );
            }
        }
    };
}

kernel!(data: ".rept 64", "adds r1, r1, r2", ".endr");
kernel!(wide_data: ".rept 64", "add.w r1, r1, r2", ".endr");
// over the instruction behind it
kernel!(branch: ".rept 32", ".inst.n 0xe000", "nop", ".endr");
kernel!(load_alone: ".rept 32", "ldr r1, [r0]", "adds r2, r2, #1", ".endr");
kernel!(loads: ".rept 32", "ldr r1, [r0]", "ldr r2, [r0, #4]", ".endr");
// a constant in flash, over which it then jumps
kernel!(load_constant: ".rept 32", "ldr r1, 5f", ".endr", "b 6f", ".p2align 2", "5: .word 1", "6:");
kernel!(load_two: ".rept 32", "ldrd r1, r2, [r0]", ".endr");
kernel!(load_many: ".rept 16", "ldm r0, {{r1, r2, r3, r12}}", ".endr");
kernel!(store: ".rept 32", "str r1, [r0]", ".endr");
kernel!(store_many: ".rept 16", "stm r0, {{r1, r2, r3, r12}}", ".endr");
kernel!(push_pop: ".rept 16", "push {{r1, r2, r3}}", "pop {{r1, r2, r3}}", ".endr");
kernel!(multiply: ".rept 32", "mul r1, r2, r3", ".endr");
kernel!(multiply_add: ".rept 32", "mla r1, r2, r3, r1", ".endr");
kernel!(long_multiply_small: "mov r3, #1", "mov r12, #1", ".rept 32", "smull r1, r2, r3, r12", ".endr");
kernel!(long_multiply_large: "mvn r3, #0x80000000", "mov r12, r3", ".rept 32", "smull r1, r2, r3, r12", ".endr");
kernel!(long_multiply_add: "mvn r3, #0x80000000", "mov r12, r3", ".rept 32", "smlal r1, r2, r3, r12", ".endr");
kernel!(divide_small: "mov r3, #1", "mov r12, #1", ".rept 32", "sdiv r1, r3, r12", ".endr");
kernel!(divide_large: "mvn r3, #0x80000000", "mov r12, #3", ".rept 32", "sdiv r1, r3, r12", ".endr");
kernel!(skip: "cmp r1, r1", ".rept 16", "it eq", "addeq r2, r2, r3", ".endr");

#[cfg(target_abi = "eabihf")]
mod floats {
    use core::arch::asm;

    use super::Memory;

    macro_rules! kernel {
        ($name:ident: $($line:literal),+) => {
            #[inline(never)]
            pub fn $name(memory: &mut Memory, _: &(), _: &mut ()) {
                // SAFETY: within the memory; the registers are named.
                unsafe {
                    asm!(
                        "vmov.f32 s0, #1.0", "vmov.f32 s1, #1.5",
                        $($line),+,
                        inout("r0") memory => _, out("r1") _,
                        out("s0") _, out("s1") _, out("s2") _, out("s3") _,
                    );
                }
            }
        };
    }

    kernel!(add: ".rept 32", "vadd.f32 s2, s0, s1", ".endr");
    kernel!(add_to_the_sum: ".rept 32", "vadd.f32 s0, s0, s1", ".endr");
    kernel!(multiply: ".rept 32", "vmul.f32 s0, s0, s1", ".endr");
    kernel!(multiply_add: ".rept 32", "vfma.f32 s2, s0, s1", ".endr");
    kernel!(divide: ".rept 32", "vdiv.f32 s0, s0, s1", ".endr");
    kernel!(root: ".rept 32", "vsqrt.f32 s1, s0", ".endr");
    kernel!(load: ".rept 32", "vldr s2, [r0]", ".endr");
    kernel!(store: ".rept 32", "vstr s0, [r0]", ".endr");
    kernel!(load_many: ".rept 16", "vldmia r0, {{s0-s3}}", ".endr");
    kernel!(compare: ".rept 32", "vcmp.f32 s0, s1", "vmrs apsr_nzcv, fpscr", ".endr");
    kernel!(convert: ".rept 32", "vcvt.s32.f32 s2, s0", ".endr");
    kernel!(to_the_core: ".rept 32", "vmov r1, s0", ".endr");
}

/// Measures every kernel.
pub fn all<B: Board>(bench: &mut Bench<'_, B>) {
    let mut measure = |name, kernel| bench.measure(name, [0; 8], |_| (), kernel);
    measure("kernel/data", data);
    measure("kernel/wide-data", wide_data);
    measure("kernel/branch", branch);
    measure("kernel/load-alone", load_alone);
    measure("kernel/loads", loads);
    measure("kernel/load-constant", load_constant);
    measure("kernel/load-two", load_two);
    measure("kernel/load-many", load_many);
    measure("kernel/store", store);
    measure("kernel/store-many", store_many);
    measure("kernel/push-pop", push_pop);
    measure("kernel/multiply", multiply);
    measure("kernel/multiply-add", multiply_add);
    measure("kernel/long-multiply-small", long_multiply_small);
    measure("kernel/long-multiply-large", long_multiply_large);
    measure("kernel/long-multiply-add", long_multiply_add);
    measure("kernel/divide-small", divide_small);
    measure("kernel/divide-large", divide_large);
    measure("kernel/skip", skip);
    #[cfg(target_abi = "eabihf")]
    {
        measure("kernel/float-add", floats::add);
        measure("kernel/float-add-to-the-sum", floats::add_to_the_sum);
        measure("kernel/float-multiply", floats::multiply);
        measure("kernel/float-multiply-add", floats::multiply_add);
        measure("kernel/float-divide", floats::divide);
        measure("kernel/float-root", floats::root);
        measure("kernel/float-load", floats::load);
        measure("kernel/float-store", floats::store);
        measure("kernel/float-load-many", floats::load_many);
        measure("kernel/float-compare", floats::compare);
        measure("kernel/float-convert", floats::convert);
        measure("kernel/float-to-the-core", floats::to_the_core);
    }
}
