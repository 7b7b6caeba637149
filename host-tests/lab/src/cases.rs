//! Published and made-up cases that are stiff or extreme: a gear mesh through its resonances.
//!
//! The references stand in `tests/data`, each file with its source; none is this project's own code.

pub mod gear_mesh;
