//! A scene's firmware in closed loop with the full solver of its machine: how wrong the estimates are, and what they cost.

mod assemble;
pub mod blooming_mill;
pub mod body;
pub mod closed_loop;
mod comparison;
pub mod converter;
mod crane_travel;
pub mod engine;
mod facts;
mod fan;
pub mod figures;
pub mod gear_drive;
pub mod hoist;
pub mod plan;
mod planetary_drive;
pub mod punch_press;
pub mod scenario;
pub mod sensors;
mod skip_winch;
mod spindle;
mod strip_mill;
pub mod units;
pub mod vibrating_screen;

pub use assemble::Plan;

use crate::plant::PlantError;
use scenario::Machine;

/// What makes a scene's machine with its plants.
pub type Build = fn() -> Result<Machine, PlantError>;

/// The machines that can be run, by the names of their scenes; the first also carries what belongs to no scene.
pub const SCENES: &[(&str, Build)] = &[
    ("hoist", hoist::machine),
    ("fan", fan::machine),
    ("spindle", spindle::machine),
    ("strip-mill", strip_mill::machine),
    ("planetary", planetary_drive::machine),
    ("crane-travel", crane_travel::machine),
    ("skip-winch", skip_winch::machine),
    ("punch-press", punch_press::machine),
    ("blooming-mill", blooming_mill::machine),
    ("converter", converter::machine),
    ("vibrating-screen", vibrating_screen::machine),
    ("gear-drive", gear_drive::machine),
];
