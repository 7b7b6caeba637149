//! The host's data on a board.

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
