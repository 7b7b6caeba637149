//! Boards: the interface of the binaries to a board, and the host's data to build for it and run it.
//!
//! A new board of QEMU's is one file beside [`mps2_an386`] with its [`Facts`] and its [`Board`], a line in [`BOARDS`]
//! and one in the choice below, and, where its memory is not that of `mps2.x`, a `.x` file of the same name. A board
//! with a motor ([`nucleo_g474re`]) implements [`driveline::hal::Board`] instead; `doc/boards.md` says how.

pub mod json_line;
pub mod mps2_an385;
pub mod mps2_an386;
pub mod mps2_an500;
pub mod mps2_an505;
pub mod nucleo_g474re;

#[cfg(all(feature = "target", target_os = "none"))]
mod cmsdk_timer;
#[cfg(all(feature = "target", feature = "defmt", target_os = "none"))]
mod logger;
#[cfg(all(feature = "target", target_os = "none"))]
mod panic;
#[cfg(all(feature = "target", target_os = "none"))]
mod semihosting;
#[cfg(all(feature = "target", target_os = "none"))]
pub use semihosting::Sink;

#[cfg(all(feature = "target", target_os = "none", driveline_board = "mps2-an385"))]
pub use mps2_an385::Mps2An385 as ThisBoard;
#[cfg(all(feature = "target", target_os = "none", driveline_board = "mps2-an386"))]
pub use mps2_an386::Mps2An386 as ThisBoard;
#[cfg(all(feature = "target", target_os = "none", driveline_board = "mps2-an500"))]
pub use mps2_an500::Mps2An500 as ThisBoard;
#[cfg(all(feature = "target", target_os = "none", driveline_board = "mps2-an505"))]
pub use mps2_an505::Mps2An505 as ThisBoard;

use crate::scene::{Input, Output};

/// The host's data to build for a board and to run it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Facts {
    /// The board's name, and that of QEMU's machine: `mps2-an386`.
    pub name: &'static str,
    /// Its core, as in `budgets.toml`: `m4f`.
    pub core: &'static str,
    /// The compiler's target.
    pub target: &'static str,
}

/// The boards whose cores have budgets.
pub const BOARDS: &[Facts] = &[mps2_an386::FACTS, mps2_an385::FACTS];

/// Further cores, on which the self-test gives the same bits. The M0+ is code for it on the M3, which runs it: QEMU has
/// no board of that core.
pub const FURTHER: &[Facts] = &[
    mps2_an500::FACTS,
    mps2_an505::FACTS,
    Facts { core: "m0plus", target: "thumbv6m-none-eabi", ..mps2_an385::FACTS },
];

/// Interface of the binaries to a board.
pub trait Board {
    /// The host's data on it.
    const FACTS: Facts;
    /// The way in and out of a control loop.
    type Link: Link;

    /// Starts the counter.
    fn start() -> Self;
    /// A free-running 32-bit counter that goes up.
    fn count(&self) -> u32;
    /// Instructions (or cycles, on a board that has no exact count of them) in a difference of counts.
    fn instructions(counts: u32) -> u32;
    /// Opens the link of a control loop; `None` where there is none.
    fn open_link(&self) -> Option<Self::Link>;
    /// Prints a line, its end included.
    fn print(&self, line: &[u8]);
    /// Ends the run, with success or without.
    fn exit(&self, success: bool) -> !;
}

/// The way in and out of a control loop, in lock-step.
pub trait Link {
    /// Waits for the next input; false at the end of the run.
    fn receive(&self, input: &mut Input) -> bool;
    /// Sends an output; false where the other side has gone.
    fn send(&self, output: &Output) -> bool;
}
