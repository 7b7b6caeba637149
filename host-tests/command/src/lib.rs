//! The subcommands of `cargo driveline`, machine files, and the runs behind them: scenes in closed loop, balancing,
//! generator sets, commissioning, campaigns, backlash, sweeps, co-simulation with FMUs, the survey of all.
#![deny(unsafe_code)]

pub mod backlash;
pub mod balancing;
pub mod campaign;
pub mod cases;
pub mod check;
pub mod cli;
pub mod closed_loop;
pub mod commissioning;
pub mod cosim;
pub mod drivetrains;
pub mod generator;
pub mod identification;
pub mod machine_file;
pub mod peers;
pub mod recording;
pub mod replay;
pub mod scope;
mod stamp;
pub mod survey;
pub mod sweep;
pub mod telemetry;
