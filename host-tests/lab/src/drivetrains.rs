//! A scene's firmware in closed loop with the full solver of its machine: how wrong the estimates are, and what they
//! cost.

pub mod engine;
mod facts;
mod plan;

pub use plan::{Plan, Variants};

use driveline_closed_loop::scenario::Machine;
use driveline_solver::plant::PlantError;

/// Builder of a scene's machine with its plants.
pub type Build = fn() -> Result<Machine, PlantError>;

/// A file here for each scene of the firmware's table.
macro_rules! machines {
    ($($scene:ident)+) => {
        $(pub mod $scene;)+

        /// The machines that can be run, by the names of their scenes.
        pub const SCENES: &[(&str, Build)] = &[$((driveline_firmware::scenes::$scene::SCENE, $scene::machine)),+];
    };
}

driveline_firmware::drivetrains!(machines);
