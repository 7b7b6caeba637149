//! The scenes: one file each, and one line of a table.
//!
//! A scene's name is that of its file. The file says what the machine is and lists the variants that can be flashed. A
//! scene of `drivetrains!` also has a file of the same name in the host's folder `drivetrains`, with its plant and
//! its runs. Names, images, the host's lists and the budgets' keys follow from these tables; `DRIVELINE_VARIANT`
//! chooses a variant when a binary is built ([`selected!`](crate::selected!)).

use crate::scene::table::{append, key};

#[cfg(not(target_os = "none"))]
pub use crate::scene::table::Row;

/// Hands the scenes that are run against a plant to a macro, in the order of the report.
#[macro_export]
macro_rules! drivetrains {
    ($with:ident) => {
        $with! {
            hoist
            spindle
            strip_mill
            crane_travel
            punch_press
            blooming_mill
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
            surface_grinder
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
        static ROWS: &[&[Row]] = &[$($scene::ROWS),+];
    };
}

drivetrains!(others);

/// The names of all variants.
pub const VARIANTS: &[&str] = &flat::<{ count(NAMES) }>(NAMES);

/// The names of several scenes in one list.
const fn flat<const COUNT: usize>(scenes: &[&[&'static str]]) -> [&'static str; COUNT] {
    let mut names = [""; COUNT];
    let (mut scene, mut at) = (0, 0);
    while scene < scenes.len() {
        let mut variant = 0;
        while variant < scenes[scene].len() {
            names[at] = scenes[scene][variant];
            at += 1;
            variant += 1;
        }
        scene += 1;
    }
    names
}

/// The number of names in a list of scenes.
const fn count(scenes: &[&[&str]]) -> usize {
    let (mut scene, mut count) = (0, 0);
    while scene < scenes.len() {
        count += scenes[scene].len();
        scene += 1;
    }
    count
}

/// The variant called `name`; `None` where there is none.
#[cfg(not(target_os = "none"))]
pub fn find(name: &str) -> Option<&'static Row> {
    ROWS.iter().flat_map(|scene| scene.iter()).find(|row| row.name == name)
}

/// The key of the variant called `name`.
///
/// # Panics
/// When there is none, with the names that there are; at compile time, where the binaries call it.
pub const fn known(name: &str) -> u64 {
    let known = key(name);
    let mut line = 0;
    while line < VARIANTS.len() {
        if key(VARIANTS[line]) == known {
            return known;
        }
        line += 1;
    }
    let mut text = [0; 8192];
    let mut length = append(&mut text, 0, &["DRIVELINE_VARIANT is `", name, "`; firmware/src/scenes.rs has"]);
    let mut line = 0;
    while line < VARIANTS.len() {
        length = append(&mut text, length, &[" `", VARIANTS[line], "`"]);
        line += 1;
    }
    match core::str::from_utf8(text.split_at(length).0) {
        Ok(text) => panic!("{}", text),
        Err(_) => panic!("DRIVELINE_VARIANT names no variant of firmware/src/scenes.rs"),
    }
}

/// Gives a binary `Selected`, the variant that `DRIVELINE_VARIANT` names, and `driveline_tick`, its tick as a function
/// of its own, so that its code and instructions can be measured.
///
/// `selected!("name")` is for a binary with another default than the hoist's. Only the binary depends on the choice:
/// the library with all scenes is compiled once for all variants.
#[macro_export]
macro_rules! selected {
    () => {
        $crate::selected!("hoist/f32/reduced/10000");
    };
    ($default:literal) => {
        /// The variant that this image holds; the default where none is named.
        type Selected = <$crate::scene::table::Table as $crate::scene::table::Select<
            {
                $crate::scenes::known(match option_env!("DRIVELINE_VARIANT") {
                    Some(name) => name,
                    None => $default,
                })
            },
        >>::Variant;

        /// One tick of the scene that this image holds.
        #[unsafe(no_mangle)]
        #[unsafe(link_section = ".text.driveline_tick")]
        #[inline(never)]
        extern "Rust" fn driveline_tick(
            scene: &mut <Selected as $crate::scene::Variant>::Scene,
            input: &$crate::scene::Input,
            output: &mut $crate::scene::Output,
        ) {
            *output = $crate::scene::Scene::tick(scene, input);
        }
    };
}
