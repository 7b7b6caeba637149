//! Recordings of machines: a table in CSV whose columns are named by quantity and unit.

mod angle;
mod column;
mod decimal;
mod read;

pub use angle::unwrapped;
pub use column::{Column, Quantity};
pub use read::{Asked, Recording, parse, read_recording};
