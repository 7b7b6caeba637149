//! A drive in closed loop with the full solver of its machine: what ticks, what its sensors read, its units, the runs
//! of a machine, and the errors of the estimates.
#![deny(unsafe_code)]

pub mod actuator;
pub mod departure;
pub mod encoder_errors;
pub mod figures;
pub mod lockstep;
pub mod plant;
pub mod scenario;
pub mod sensors;
pub mod ticks;
pub mod units;
