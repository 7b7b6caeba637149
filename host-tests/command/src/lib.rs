//! The subcommands of `cargo driveline` for who designs a machine: machine files, designs, simulations, balancing,
//! campaigns, co-simulation with FMUs, recordings, new projects and exports.
#![deny(unsafe_code)]

pub mod campaign;
pub mod cli;
pub mod cosim;
pub mod identification;
pub mod machine_file;
pub mod recording;
pub mod replay;
pub mod scope;
pub mod telemetry;
