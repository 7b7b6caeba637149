//! The command line: a subcommand a file. A page in a browser has what shows a design and weights.
//!
//! | exit code | meaning |
//! |---|---|
//! | 0 | done |
//! | 1 | done, and the answer is no: a check failed, a run could not finish |
//! | 2 | not begun: a wrong argument or a machine file with a fault |
//!
//! Results go to standard output, progress and errors to standard error; an error is a sentence, with `--json` the
//! object `{"error": ...}`.

pub mod balance;
#[cfg(not(target_family = "wasm"))]
mod campaign;
#[cfg(not(target_family = "wasm"))]
mod command_line;
mod controller;
#[cfg(not(target_family = "wasm"))]
mod cosim;
pub mod design;
mod emit;
#[cfg(not(target_family = "wasm"))]
mod example;
#[cfg(not(target_family = "wasm"))]
mod export;
pub mod failure;
#[cfg(not(target_family = "wasm"))]
mod identify;
#[cfg(not(target_family = "wasm"))]
mod modes;
#[cfg(not(target_family = "wasm"))]
mod new;
pub mod output;
#[cfg(not(target_family = "wasm"))]
mod page;
#[cfg(not(target_family = "wasm"))]
pub mod progress;
#[cfg(not(target_family = "wasm"))]
mod project;
#[cfg(not(target_family = "wasm"))]
mod qemu;
#[cfg(not(target_family = "wasm"))]
mod recorded;
#[cfg(not(target_family = "wasm"))]
mod replay;
#[cfg(not(target_family = "wasm"))]
pub mod results;
#[cfg(not(target_family = "wasm"))]
mod rotor;
#[cfg(not(target_family = "wasm"))]
pub mod setup;
#[cfg(not(target_family = "wasm"))]
mod shell;
#[cfg(not(target_family = "wasm"))]
mod simulate;
#[cfg(not(target_family = "wasm"))]
mod watch;

#[cfg(not(target_family = "wasm"))]
pub use command_line::{Command, CommandLine, answer, main, run};
pub use controller::Plan;
pub use emit::rust;
pub use failure::Failure;
#[cfg(not(target_family = "wasm"))]
pub use modes::Vibration;
pub use output::{say, say_json};
#[cfg(not(target_family = "wasm"))]
pub use progress::Progress;
