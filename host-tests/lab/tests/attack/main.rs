//! Attacks on the command: malformed files, streams and argument lists, results onto sources, a full disk, signals.
//!
//! Each attack has a number, from which all of it follows. `cargo test` runs some; the whole runs are ignored for their
//! length and are steps of `cargo lab check --long`.

mod arguments;
mod cases;
mod disk;
mod limits;
mod links;
mod malformed;
mod random;
mod run;
mod signals;
