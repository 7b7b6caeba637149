//! A scene's firmware in closed loop with the full solver of its machine: how wrong the estimates are, and what they cost.

mod assemble;
pub mod blooming_mill;
pub mod closed_loop;
mod comparison;
pub mod converter;
pub mod engine;
mod facts;
pub mod figures;
pub mod hoist;
pub mod plan;
pub mod scenario;
pub mod sensors;
pub mod units;

pub use assemble::Plan;
