//! Proof that a recorded run has converged: the run is done again by other means and must come out the same.
//!
//! As that of a [train](super::train::converge), which the chain is.
//!
//! ```
//! use driveline_solver::plant::{Chain, Shaft};
//! use driveline_solver::plant::converge::{Recording, prove};
//! let drive = Chain::motor(1.2).shaft(Shaft::elastic(850.0).damping(0.5).gap(0.06), 0.35).load(120.0).build()?;
//! let mut run = Recording::new(drive);
//! for _ in 0..500 {
//!     run.advance(200.0, 1e-3);
//! }
//! let proof = prove(&run)?;
//! assert!(proof.largest() <= 1e-8);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub(super) mod pass;
mod proof;

pub use super::train::converge::chain::{Recording, prove};
pub use proof::{BOUND, Deviation, NotProven, Proof, Sensitive};
