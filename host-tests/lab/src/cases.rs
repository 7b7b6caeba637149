//! Published and made-up cases that are stiff or extreme, each held to its reference: natural frequencies of chains
//! with extreme ratios, starts and reversals through backlash, a gear mesh through its resonances.
//!
//! The references stand in `tests/data`, each file with its source; none is this project's own code.

mod case;
pub mod chains;
pub mod gear_mesh;
pub mod transients;

pub use case::Case;
use case::larger;

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
