//! A scene's firmware in closed loop with the full solver of its machine: how wrong the estimates are, and what they cost.

pub mod approximate;
pub mod blooming_mill;
pub mod converter;
mod crane_travel;
pub mod engine;
mod facts;
mod fan;
pub mod figures;
pub mod gear_drive;
pub mod hoist;
pub mod lockstep;
pub mod other_steps;
mod plan;
mod planetary_drive;
pub mod plant;
pub mod punch_press;
pub mod scenario;
mod skip_winch;
mod spindle;
mod strip_mill;
pub mod vibrating_screen;

pub use plan::{Plan, Variants};

use driveline_solver::plant::PlantError;
use scenario::Machine;

/// What makes a scene's machine with its plants.
pub type Build = fn() -> Result<Machine, PlantError>;

/// The machines that can be run, by the names of their scenes.
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
