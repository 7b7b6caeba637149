//! The switch of the mutants: which one is on, and which ones were reached.

extern crate std;

use core::ffi::c_int;
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering::Relaxed};
use std::boxed::Box;
use std::string::String;

/// In this state each mutant that is reached is noted, and none is on.
const NOTING: u32 = u32::MAX;

static ON: AtomicU32 = AtomicU32::new(0);
static REACHED: [AtomicBool; 16_384] = [const { AtomicBool::new(false) }; 16_384];

/// Whether the mutant `number` is on: never where the compiler evaluates.
#[inline(always)]
pub const fn on(number: u32) -> bool {
    core::intrinsics::const_eval_select((number,), off, read)
}

const fn off(_: u32) -> bool {
    false
}

#[inline(always)]
fn read(number: u32) -> bool {
    let on = ON.load(Relaxed);
    on == number || (on == NOTING && note(number))
}

#[cold]
#[inline(never)]
fn note(number: u32) -> bool {
    REACHED[number as usize].store(true, Relaxed);
    false
}

unsafe extern "C" {
    fn atexit(end: extern "C" fn()) -> c_int;
    fn _exit(code: c_int) -> !;
}

#[used]
#[unsafe(link_section = ".init_array")]
static BEGIN: extern "C" fn() = begin;

/// Before `main`: the mutant is taken from the environment, and the first panic ends the process.
extern "C" fn begin() {
    let Ok(asked) = std::env::var("MUTANT") else { return };
    if asked == "reached" {
        ON.store(NOTING, Relaxed);
        unsafe { atexit(end) };
    } else {
        ON.store(asked.parse().expect("a number of a mutant"), Relaxed);
    }
    std::panic::set_hook(Box::new(|_| unsafe { _exit(101) }));
}

extern "C" fn end() {
    let mut numbers = String::new();
    for (number, reached) in REACHED.iter().enumerate() {
        if reached.load(Relaxed) {
            numbers += &std::format!("{number} ");
        }
    }
    let _ = std::fs::write(std::env::var("MUTANTS_REACHED").unwrap_or_default(), numbers);
}
