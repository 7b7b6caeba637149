//! Arm MPS2 with the AN505 image: a Cortex-M33 with an FPU of single precision, in its secure state, at 20 MHz.

use super::facts::Facts;

/// The host's data on it.
pub const FACTS: Facts = Facts { name: "mps2-an505", core: "m33", target: "thumbv8m.main-none-eabihf" };

/// The board, as QEMU models it.
#[cfg(all(feature = "target", target_arch = "arm"))]
pub struct Mps2An505(super::cmsdk_timer::SecureTimer0);

#[cfg(all(feature = "target", target_arch = "arm"))]
super::cmsdk_timer::qemu_mps2!(Mps2An505, SecureTimer0);
