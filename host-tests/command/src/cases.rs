//! Published and made-up cases that are stiff or extreme, each held to its reference: natural frequencies of chains with
//! extreme ratios, starts and reversals through backlash, a gear mesh through its resonances.
//!
//! The references stand in `host-tests/command/tests/data`, each file with its source; none is this project's own code.

pub mod chains;
pub mod gear_mesh;
pub mod transients;

use serde::Serialize;

/// A case and what came of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Case {
    /// What kind of case it is.
    pub group: &'static str,
    /// The case.
    pub name: String,
    /// What is compared.
    pub compared: &'static str,
    /// Largest error, relative.
    pub found: f64,
    /// What it may be.
    pub allowed: f64,
}

impl Case {
    /// Whether it is within its tolerance. What is not a number is not.
    pub fn holds(&self) -> bool {
        self.found <= self.allowed
    }
}

/// The larger of two errors; what is not a number is without bound.
fn larger(worst: f64, error: f64) -> f64 {
    if error.is_nan() { f64::INFINITY } else { worst.max(error) }
}

/// Every case.
///
/// # Errors
/// A reference that cannot be read, or a machine that cannot be set up, which only a changed file can bring.
pub fn all() -> Result<Vec<Case>, String> {
    let mut all = chains::all()?;
    all.extend(transients::all()?);
    all.extend(gear_mesh::all()?);
    Ok(all)
}
