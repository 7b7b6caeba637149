//! Proofs about a drive: how far fixed point may ever be from real numbers, and that its speed loop is stable for every
//! machine within the tolerances.

pub mod disc;
pub mod measured;
pub mod rounding;
pub mod stability;

pub mod subject;
