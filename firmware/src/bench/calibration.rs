//! Functions of a known number of instructions.

use core::arch::asm;

/// Ten instructions and a return.
#[inline(never)]
pub fn ten_nops(_: &mut (), _: &(), _: &mut ()) {
    // SAFETY: does nothing.
    unsafe {
        asm!(
            ".rept 10",
            "nop",
            ".endr",
            options(nomem, nostack, preserves_flags)
        )
    };
}

/// A thousand instructions and a return.
#[inline(never)]
pub fn thousand_nops(_: &mut (), _: &(), _: &mut ()) {
    // SAFETY: does nothing.
    unsafe {
        asm!(
            ".rept 1000",
            "nop",
            ".endr",
            options(nomem, nostack, preserves_flags)
        )
    };
}
