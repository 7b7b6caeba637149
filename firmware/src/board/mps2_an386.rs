//! Arm MPS2 with the AN386 image: a Cortex-M4F at 25 MHz.

use super::facts::Facts;

/// The host's data on it.
pub const FACTS: Facts = Facts { name: "mps2-an386", core: "m4f", target: "thumbv7em-none-eabihf" };

/// The board, as QEMU models it.
#[cfg(all(feature = "target", target_arch = "arm"))]
pub struct Mps2An386(super::cmsdk_timer::Timer0);

#[cfg(all(feature = "target", target_arch = "arm"))]
super::cmsdk_timer::qemu_mps2!(Mps2An386, Timer0);
