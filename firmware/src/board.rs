//! Boards: the interface of the binaries to a board, and the host's data to build for it and run it.
//!
//! A new board of QEMU's is one file beside [`mps2_an386`] with its [`Facts`] and its [`Board`]. It has a line in
//! [`BOARDS`] and one in the choice below. Where its memory is not that of `mps2.x`, it brings a `.x` file of the same
//! name. A board with a motor ([`nucleo_g474re`]) implements [`driveline::axis::Board`] instead; `doc/makers/boards.md`
//! says how.

pub mod facts;
pub mod interface;
pub mod json_line;
pub mod mps2_an385;
pub mod mps2_an386;
pub mod mps2_an500;
pub mod mps2_an505;
pub mod nucleo_g474re;
pub mod virt;

#[cfg(all(feature = "target", target_arch = "arm"))]
mod cmsdk_timer;
#[cfg(all(feature = "target", feature = "defmt", target_os = "none"))]
mod logger;
#[cfg(all(feature = "target", target_os = "none"))]
mod panic;
#[cfg(all(feature = "target", target_os = "none"))]
mod semihosting;
#[cfg(all(feature = "target", target_os = "none"))]
pub use semihosting::Sink;

pub use facts::Facts;
pub use interface::{Board, Link};

#[cfg(all(feature = "target", target_os = "none", driveline_board = "mps2-an385"))]
pub use mps2_an385::Mps2An385 as ThisBoard;
#[cfg(all(feature = "target", target_os = "none", driveline_board = "mps2-an386"))]
pub use mps2_an386::Mps2An386 as ThisBoard;
#[cfg(all(feature = "target", target_os = "none", driveline_board = "mps2-an500"))]
pub use mps2_an500::Mps2An500 as ThisBoard;
#[cfg(all(feature = "target", target_os = "none", driveline_board = "mps2-an505"))]
pub use mps2_an505::Mps2An505 as ThisBoard;
#[cfg(all(feature = "nucleo-g474re", target_os = "none", driveline_board = "nucleo-g474re"))]
pub use nucleo_g474re::NucleoG474re as ThisBoard;
#[cfg(all(feature = "target", target_arch = "riscv32", driveline_board = "virt"))]
pub use virt::Virt as ThisBoard;

/// The boards whose cores have budgets.
pub const BOARDS: &[Facts] = &[mps2_an386::FACTS, mps2_an385::FACTS];

/// Further cores, on which the self-test gives the same bits. The M0+ is code for it on the M3, which runs it: QEMU has
/// no board of that core.
pub const FURTHER: &[Facts] = &[
    mps2_an500::FACTS,
    mps2_an505::FACTS,
    Facts { core: "m0plus", target: "thumbv6m-none-eabi", ..mps2_an385::FACTS },
];

/// RISC-V: cores without and with a unit for single precision, on which the self-test gives the same bits.
pub const RISC_V: &[Facts] = &[virt::IMAC, virt::IMAFC];
