//! NUCLEO-G474RE: a Cortex-M4F at 170 MHz with a timer for motors, and a motor behind a drive or a bridge.
//!
//! `nucleo_g474re/nucleo.rs` is the board: [`driveline::axis::Board`] from drivers of `driveline-hal`. The files beside
//! it are its registers, one peripheral each, through `stm32-metapac`, the crate of registers that `embassy-stm32`
//! stands on: the image may hold no reachable panic, and a hardware layer that checks its arguments at run time has
//! some.
//! `nucleo_g474re/console.rs` is the board of the bench alone, which drives nothing and counts cycles.
//! `doc/makers/boards.md` has the wiring. **It has not run on hardware.**
//!
//! Registers: ST RM0440. Pins: ST DS12288. Names in capitals are theirs.

use super::facts::Facts;

/// The host's data on it; QEMU has no such machine.
pub const FACTS: Facts = Facts { name: "nucleo-g474re", core: "g474", target: "thumbv7em-none-eabihf" };

/// Frequency of the PWM (Hz).
pub const PWM_HZ: u32 = 20_000;
/// Dead time of TIM1 (s): for that long after each edge both outputs of a pair are off.
pub const DEAD_TIME: f64 = 1e-6;
/// The outputs of TIM1, port and number, of each phase: CHx and CHxN. An image drives those that it uses.
pub const PHASE_PINS: [[(char, usize); 2]; 3] = [[('A', 8), ('A', 7)], [('A', 9), ('B', 0)], [('A', 10), ('B', 1)]];

/// The torque (N m) at full duty of an output that has to give up to `torque`.
///
/// A pulse shorter than the dead time is lost, so the last two hundredths of the duty at either end are flat, with a
/// step. Up to `torque` the duty stays out of them.
pub const fn full_scale(torque: f64) -> f64 {
    torque / (1.0 - 2.0 * DEAD_TIME * PWM_HZ as f64)
}

pub mod reset;
pub mod ring_reader;

#[cfg(all(feature = "nucleo-g474re", target_os = "none"))]
mod bridge;
#[cfg(all(feature = "nucleo-g474re", target_os = "none"))]
mod clock;
#[cfg(all(feature = "nucleo-g474re", target_os = "none"))]
mod console;
#[cfg(all(feature = "nucleo-g474re", target_os = "none"))]
mod encoder;
#[cfg(all(feature = "nucleo-g474re", target_os = "none"))]
mod nucleo;
#[cfg(all(feature = "nucleo-g474re", target_os = "none"))]
mod pin;
#[cfg(all(feature = "nucleo-g474re", target_os = "none"))]
mod serial;
#[cfg(all(feature = "nucleo-g474re", target_os = "none"))]
mod tick;
#[cfg(all(feature = "nucleo-g474re", target_os = "none"))]
mod vibration;
#[cfg(all(feature = "nucleo-g474re", target_os = "none"))]
mod watchdog;

#[cfg(all(feature = "nucleo-g474re", target_os = "none"))]
pub use {
    bridge::Channel,
    console::NucleoG474re,
    nucleo::{Beside, Nucleo},
    pin::Pin,
    serial::Serial,
    tick::{start_tick, tick_taken},
    vibration::Vibration,
};
