//! The full solver, the link to QEMU, the command line, the report.

pub mod backlash;
pub mod balance_file;
pub mod balancing;
pub mod cases;
pub mod check;
pub mod cli;
pub mod commission;
pub mod generator;
pub mod image;
pub mod link;
pub mod machine_file;
pub mod plant;
pub mod report;
pub mod rotor;
pub mod run;
pub mod setup;
pub mod survey;
pub mod sweep;
pub mod telemetry;
