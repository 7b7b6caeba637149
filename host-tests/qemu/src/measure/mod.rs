//! Measurements of images in QEMU: instructions and stack, counted and bounded, fingerprints of self-tests, budgets.

mod bound;
pub mod budgets;
mod cost;
mod search;
mod self_test;

pub use bound::MachineCode;
pub use cost::{BENCHES, Cost, Spread};
pub use driveline_longest_path::{Bound, Core, Cycles, Flash, Loops, Piece, Refusal};
pub use search::worst_drawn;
pub use self_test::self_test;
