//! Firmware images: built for a variant and a board, and read for what they take of a controller.

mod build;
mod calls;
mod fresh;
mod machine_code;
mod sections;
mod symbols;

use std::path::PathBuf;

use driveline_firmware::board::{BOARDS, Facts};

pub use build::{BuildError, build, links};
pub use machine_code::{Function, Referent, tick_code};
pub use sections::{Contents, ReadError, Sizes};
pub use symbols::Symbol;

/// The binaries of the firmware.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Program {
    /// In lock-step with a host.
    ControlLoop,
    /// Instructions of single functions.
    Bench,
    /// The fingerprint of a run.
    SelfTest,
    /// Log of a run, through `defmt`.
    Log,
    /// Reports each tick of a run as frames of telemetry.
    Told,
    /// The test rig on the board of its own, which QEMU has not.
    Nucleo,
    /// Has a reachable panic: must not link.
    Panics,
    /// Other observers, of the crate `host-tests/peers`.
    Peers,
}

impl Program {
    /// The binary's name.
    pub const fn name(self) -> &'static str {
        match self {
            Program::ControlLoop => "control_loop",
            Program::Bench => "bench",
            Program::SelfTest => "self_test",
            Program::Log => "log",
            Program::Told => "told",
            Program::Nucleo => "nucleo_g474re",
            Program::Panics => "panics",
            Program::Peers => "peers",
        }
    }

    /// The features that it needs.
    const fn features(self) -> &'static str {
        match self {
            Program::Log => "target,defmt",
            Program::Nucleo => "nucleo-g474re",
            _ => "target",
        }
    }

    /// The folder of its crate, in the clone.
    pub(super) const fn folder(self) -> &'static str {
        match self {
            Program::Peers => "host-tests/peers",
            _ => "firmware",
        }
    }

    /// Its kind of cargo's targets.
    const fn kind(self) -> &'static str {
        match self {
            Program::Panics => "example",
            _ => "bin",
        }
    }
}

/// An image on disk.
#[derive(Clone, Debug)]
pub struct Image {
    /// The ELF file.
    pub path: PathBuf,
    /// The variant that it holds.
    pub variant: String,
    pub board: Facts,
    /// The binary.
    pub program: Program,
}

/// The variant that the board with a motor holds.
pub const ON_NUCLEO: &str = "test-rig/f32/whole/10000";

/// Whether a variant belongs on a board: floats on cores that have a unit for them, fixed point and the empty variant
/// on all.
pub fn belongs(variant: &str, board: &Facts) -> bool {
    variant.starts_with("empty/") || variant.split('/').nth(1) != Some("f32") || board.has_float_unit()
}

/// The board with a core (`m4f`), or of that name (`mps2-an386`).
pub fn board(name: &str) -> Option<Facts> {
    BOARDS.iter().copied().find(|board| board.core == name || board.name == name)
}
