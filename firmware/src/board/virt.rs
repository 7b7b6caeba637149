//! QEMU's `virt` machine with a 32-bit RISC-V core, with or without a unit for single precision.
//!
//! For self-tests: QEMU's core is no product, and instructions are counted by the core itself (`minstret`, exact under
//! `-icount`). Start-up code is here, a page long: the stack, the unit, and memory that is zero.

use super::facts::Facts;

/// The host's data on a core without the unit.
pub const IMAC: Facts = Facts { name: "virt", core: "imac", target: "riscv32imac-unknown-none-elf" };
/// The host's data on a core with the unit.
pub const IMAFC: Facts = Facts { name: "virt", core: "imafc", target: "riscv32imafc-unknown-none-elf" };

/// The board, as QEMU models it.
#[cfg(all(feature = "target", target_arch = "riscv32"))]
pub struct Virt(());

#[cfg(all(feature = "target", target_arch = "riscv32"))]
pub(super) use start::{syscall, syscall1};

#[cfg(all(feature = "target", target_arch = "riscv32"))]
mod start {
    use core::arch::{asm, global_asm};

    use super::{Facts, Virt};
    use crate::board::interface::Board;
    use crate::board::semihosting::{self, Pipes};

    // RISC-V Privileged Architecture 20211203, 3.1.6.6: bits 13 and 14 of `mstatus` switch the unit on
    global_asm!(
        ".section .start, \"ax\"",
        ".globl _start",
        "_start:",
        ".option push",
        ".option norelax",
        "la gp, __global_pointer$",
        ".option pop",
        "la sp, _stack_start",
        "li t0, 0x6000",
        "csrs mstatus, t0",
        "la t0, _zeroed_start",
        "la t1, _zeroed_end",
        "1: bgeu t0, t1, 2f",
        "sw zero, 0(t0)",
        "addi t0, t0, 4",
        "j 1b",
        "2: j main",
    );

    /// A call of the host with one number: RISC-V Semihosting 0.4, whose three instructions must be these.
    #[inline(always)]
    pub unsafe fn syscall1(number: usize, argument: usize) -> usize {
        let answer;
        // SAFETY: as the caller says; the host may read and write memory.
        unsafe {
            asm!(
                ".balign 16",
                ".option push",
                ".option norvc",
                "slli zero, zero, 0x1f",
                "ebreak",
                "srai zero, zero, 7",
                ".option pop",
                inout("a0") number => answer,
                in("a1") argument,
                options(nostack),
            );
        }
        answer
    }

    /// A call of the host with a block of arguments.
    #[inline(always)]
    pub unsafe fn syscall<T>(number: usize, arguments: &T) -> usize {
        // SAFETY: as the caller says.
        unsafe { syscall1(number, core::ptr::from_ref(arguments) as usize) }
    }

    impl Board for Virt {
        const FACTS: Facts = if cfg!(target_feature = "f") { super::IMAFC } else { super::IMAC };
        const UNIT: &'static str = "instructions";
        type Link = Pipes;

        fn start() -> Self {
            Virt(())
        }

        #[inline(always)]
        fn count(&self) -> u32 {
            let count: u32;
            // SAFETY: reading the counter of retired instructions has no side effect.
            unsafe { asm!("csrr {}, minstret", out(reg) count, options(nomem, nostack)) };
            count
        }

        fn instructions(counts: u32) -> u32 {
            counts
        }

        fn open_link(&self) -> Option<Pipes> {
            Pipes::open()
        }

        fn print(&self, line: &[u8]) {
            semihosting::print(line);
        }

        fn exit(&self, success: bool) -> ! {
            semihosting::exit(success)
        }
    }
}
