//! Measurements of images in QEMU: instructions and stack, fingerprints of self-tests, budgets.

pub mod budgets;
mod cost;
mod self_test;

pub use cost::{BENCHES, Cost, Spread};
pub use self_test::self_test;
