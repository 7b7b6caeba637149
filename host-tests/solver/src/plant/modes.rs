//! Natural frequencies and shapes of torsional systems: chains, branches and loops with gears and springs to the
//! ground.
//!
//! Two ways that share no step: the eigenvalues of the mass-normalised stiffness for ordinary machines
//! ([`System::modes`]); and a one-sided Jacobi iteration on the scaled incidence matrix `sqrt(k) B / sqrt(J)`, which
//! never forms the stiffness and so keeps every frequency to rounding whatever the ratios of inertia and stiffness
//! ([`System::frequencies`]). With damping: [`System::damped_eigenvalues`].
//! `[Derived; headings: Pfützner 1980 ch. 1, Wang 1989 ch. 3]`.
//!
//! Terms: node, shaft and inertia as in [`crate::plant`], but each part on its own shaft, not referred to the motor;
//! a coordinate is the angle of a node that no gear ties to another.

mod eigen;
mod frequencies;
mod system;

pub use eigen::Modes;
pub use system::{System, SystemError};
