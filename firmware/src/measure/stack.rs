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

/// Bytes that have been used below a measured call's frame since the last [`paint`].
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

/// Words below the deepest call that are looked at after each one: more than a frame leaves unwritten at its top.
const WATCHED: u32 = 128;

/// The most stack of measured calls, apart from deeper work between them.
#[derive(Debug)]
pub struct Deepest(u32);

impl Deepest {
    /// Paints the memory below the caller's frame.
    #[inline(always)]
    pub fn painted() -> Self {
        paint();
        Deepest(0)
    }

    /// After a measured call.
    #[inline(always)]
    pub fn after_call(&mut self) {
        if self.is_exceeded() {
            self.0 = self.0.max(used());
        }
    }

    /// After work between the calls: paints anew where it went deeper.
    #[inline(always)]
    pub fn after_work(&mut self) {
        if self.is_exceeded() {
            paint();
        }
    }

    /// Bytes of stack.
    pub fn bytes(&self) -> u32 {
        self.0
    }

    /// Whether there is something else than paint just below the deepest call.
    #[inline(always)]
    fn is_exceeded(&self) -> bool {
        let deepest = AT_CALL.load(Ordering::Relaxed).wrapping_sub(self.0);
        (1..=WATCHED).any(|word| {
            // SAFETY: painted memory below the stack pointer at a call: nothing lives there, every word is initialised.
            unsafe { ((deepest - 4 * word) as *const u32).read_volatile() != PAINT }
        })
    }
}

#[inline(always)]
fn pointer() -> u32 {
    let pointer: u32;
    // SAFETY: reads a register.
    unsafe { asm!("mov {}, sp", out(reg) pointer, options(nomem, nostack, preserves_flags)) };
    pointer
}
