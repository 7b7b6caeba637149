//! A drive in closed loop with the full solver of its machine: what ticks, what its sensors read, its units.

pub mod actuator;
pub mod candidates;
pub mod encoder_errors;
pub mod sensors;
pub mod ticks;
pub mod units;
