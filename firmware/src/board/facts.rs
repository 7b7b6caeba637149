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

impl Facts {
    /// Whether its core computes in single precision.
    pub fn has_float_unit(&self) -> bool {
        self.target.ends_with("hf") || self.target.starts_with("riscv32imafc")
    }

    /// Whether its core is a RISC-V.
    pub fn is_risc_v(&self) -> bool {
        self.target.starts_with("riscv")
    }
}
