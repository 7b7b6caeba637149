//! The scenes: one file each, and one line of a table.
//!
//! A scene's name is that of its file. The file says what the machine is and lists the variants that can be flashed. A
//! scene of [`drivetrains!`] also has a file of the same name in the host's folder `drivetrains`, with its plant and
//! its runs. Names, images, the host's lists and the budgets' keys follow from these tables; `DRIVELINE_VARIANT`
//! chooses a variant when a binary is built ([`selected!`](crate::selected!)).

use crate::scene::table::{count, flat};

#[cfg(not(target_os = "none"))]
pub use crate::scene::table::{Row, find};

/// Hands the scenes that are run against a plant to a macro, in the order of the report.
#[macro_export]
macro_rules! drivetrains {
    ($with:ident) => {
        $with! {
            hoist
            fan
            spindle
            strip_mill
            planetary
            crane_travel
            skip_winch
            punch_press
            blooming_mill
            converter
            vibrating_screen
            gear_drive
            belt_conveyor
        }
    };
}

/// Hands the other scenes to a macro, after those that it was given.
macro_rules! others {
    ($($drivetrain:ident)+) => {
        scenes! {
            $($drivetrain)+
            empty
            composition
            generator
            balanced_fan
            flexible
            grinding_spindle
            commission
            test_rig
        }
    };
}

macro_rules! scenes {
    ($($scene:ident)+) => {
        $(pub mod $scene;)+

        /// The names of the variants, scene by scene.
        const NAMES: &[&[&str]] = &[$($scene::NAMES),+];

        /// The variants, scene by scene.
        #[cfg(not(target_os = "none"))]
        pub(crate) static ROWS: &[&[crate::scene::table::Row]] = &[$($scene::ROWS),+];
    };
}

drivetrains!(others);

/// The names of all variants.
pub const VARIANTS: &[&str] = &flat::<{ count(NAMES) }>(NAMES);
