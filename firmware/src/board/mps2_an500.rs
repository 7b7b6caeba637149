//! Arm MPS2 with the AN500 image: a Cortex-M7 with an FPU of single precision, at 25 MHz.

use super::facts::Facts;

/// The host's data on it.
pub const FACTS: Facts = Facts { name: "mps2-an500", core: "m7", target: "thumbv7em-none-eabihf" };

/// The board, as QEMU models it.
#[cfg(all(feature = "target", target_arch = "arm"))]
pub struct Mps2An500(super::cmsdk_timer::Timer0);

#[cfg(all(feature = "target", target_arch = "arm"))]
super::cmsdk_timer::qemu_mps2!(Mps2An500, Timer0);
