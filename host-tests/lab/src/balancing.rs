//! Scenes whose rotor is balanced: the machine with its unbalance, who operates it, and what came of it.
//!
//! The drive in the firmware governs the speed of a drivetrain; the drivetrain's turning, with its ripple, turns a
//! whirling rotor; the rotor's vibration goes back into the firmware, whose panel says which weights to set. The
//! operator here does what a person does at the machine: starts, waits, presses a key, stops, sets a weight.
//!
//! | term | meaning |
//! |---|---|
//! | run | from standstill to standstill, with the readings that were taken |
//! | grade | balance quality grade G of what unbalance is left, `e Omega` in mm/s [ISO 21940-11] |
//! | setting | a weight as installed: off by a few percent and degrees from the requested one |

mod error;
mod fan;
mod four_parts;
mod grinder;
mod in_run;
mod machine;
mod operator;
mod outcome;
mod power_cut;
mod rig;
mod scene;
mod scenes;
mod tables;
mod trials;

pub use error::BalancingError;
pub use grinder::{GrinderStart, grinder};
pub use in_run::Course;
pub use machine::{Drivetrain, Machine, Seen};
pub use operator::{Hand, Operator};
pub use outcome::{Claim, Outcome, Stage, Vector};
pub use power_cut::PowerCuts;
pub use rig::rig;
pub use scene::{Cost, Ran, Scene};
pub use scenes::scenes;
pub use tables::tables;
