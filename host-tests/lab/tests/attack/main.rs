//! Attacks on the command: malformed files and streams, results onto sources, a full disk, signals.
//!
//! Each attack has a number, from which all of it follows. `cargo test` runs some; the whole runs are ignored for their
//! length and are steps of `cargo lab check --long`.

mod cases;
mod disk;
mod limits;
mod links;
mod malformed;
mod random;
mod run;
mod signals;
