//! Stack that measured calls use: the memory below is painted before and searched for overwritten paint after.
//!
//! Only what is below the stack pointer at the call counts ([`mark`]), so the loop's own frame does not. A slot that a
//! function reserves at its lowest address and never writes is not seen.

use core::arch::asm;
use core::sync::atomic::{AtomicU32, Ordering};

/// Bytes below the stack pointer that are painted; a call that goes deeper reads as this many.
pub const PAINTED: u32 = 16 * 1024;
const PAINT: u32 = 0x5AC3_96E7;

/// Stack pointer at the last measured call.
static AT_CALL: AtomicU32 = AtomicU32::new(0);

/// Remembers the stack pointer of the frame that makes a measured call.
#[inline(always)]
pub(super) fn mark() {
    AT_CALL.store(pointer(), Ordering::Relaxed);
}

/// Paints the memory below the caller's frame.
#[inline(always)]
pub fn paint() {
    // SAFETY: below the stack pointer there is nothing that lives: no interrupt is enabled, no red zone on Arm.
    unsafe {
        asm!(
            "2: subs {at}, {at}, #4",
            "str {paint}, [{at}]",
            "cmp {at}, {low}",
            "bhi 2b",
            at = inout(reg) pointer() => _,
            low = in(reg) pointer() - PAINTED,
            paint = in(reg) PAINT,
        );
    }
}

/// Bytes that measured calls have used since the caller called [`paint`].
#[inline(always)]
pub fn used() -> u32 {
    let lowest: u32;
    // SAFETY: reads the memory that `paint` has written; the search ends at the stack pointer at the latest.
    unsafe {
        asm!(
            "2: ldr {word}, [{at}]",
            "cmp {word}, {paint}",
            "bne 3f",
            "adds {at}, {at}, #4",
            "cmp {at}, {high}",
            "blo 2b",
            "3:",
            at = inout(reg) pointer() - PAINTED => lowest,
            word = out(reg) _,
            high = in(reg) pointer(),
            paint = in(reg) PAINT,
            options(readonly),
        );
    }
    AT_CALL.load(Ordering::Relaxed).saturating_sub(lowest)
}

#[inline(always)]
fn pointer() -> u32 {
    let pointer: u32;
    // SAFETY: reads a register.
    unsafe { asm!("mov {}, sp", out(reg) pointer, options(nomem, nostack, preserves_flags)) };
    pointer
}
