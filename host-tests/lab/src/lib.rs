//! The laboratory: the firmware's scenes in closed loop, balancing, generator sets, commissioning, backlash,
//! peers, the survey of all, and the check of everything. It is for who changes the code, and is not published.
#![deny(unsafe_code)]

pub mod atlas;
pub mod backlash;
pub mod balancing;
pub mod campaign;
pub mod candidates;
pub mod cases;
pub mod check;
pub mod cli;
pub mod commissioning;
pub mod drivetrains;
pub mod extremes;
pub mod generator;
pub mod peers;
pub mod proof;
mod stamp;
pub mod survey;
