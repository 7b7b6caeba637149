//! Recordings of machines: a table in CSV whose columns are named by quantity and unit.

mod column;
mod read;

pub use column::{Column, Quantity, Scales};
pub use read::{Asked, Recording, read_recording};
