//! The subcommands of `cargo driveline` for who designs a machine: machine files, designs, simulations, balancing,
//! campaigns, co-simulation with FMUs, recordings, new projects and exports.
#![deny(unsafe_code)]
// A page in a browser has no terminal, and leaves out what is said there.
#![cfg_attr(target_family = "wasm", allow(dead_code))]

#[cfg(not(target_family = "wasm"))]
pub mod campaign;
pub mod cli;
#[cfg(not(target_family = "wasm"))]
pub mod cosim;
pub mod identification;
pub mod machine_file;
pub mod recording;
#[cfg(not(target_family = "wasm"))]
pub mod replay;
#[cfg(not(target_family = "wasm"))]
pub mod scope;
#[cfg(not(target_family = "wasm"))]
pub mod telemetry;
