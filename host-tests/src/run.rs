//! A scene's firmware in closed loop with the full solver of its machine: how wrong the estimates are, and what they cost.

pub mod closed_loop;
pub mod hoist;
pub mod scenario;
pub mod sensors;
pub mod units;
