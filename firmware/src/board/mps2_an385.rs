//! Arm MPS2 with the AN385 image: a Cortex-M3 at 25 MHz.

use super::facts::Facts;

/// The host's data on it.
pub const FACTS: Facts = Facts { name: "mps2-an385", core: "m3", target: "thumbv7m-none-eabi" };

/// The board, as QEMU models it.
#[cfg(all(feature = "target", target_arch = "arm"))]
pub struct Mps2An385(super::cmsdk_timer::Timer0);

#[cfg(all(feature = "target", target_arch = "arm"))]
super::cmsdk_timer::qemu_mps2!(Mps2An385, Timer0);
