//! The variants that can be flashed, and the one that this image holds.
//!
//! One line a variant: its name (the scene's [`Scene::NAME`](crate::scene::Scene::NAME): scene, number, observer,
//! ticks a second) and its type. `DRIVELINE_VARIANT` chooses the line at build time; [`Selected`] is the type.

use crate::scenes::empty::Empty;
use crate::scenes::placeholder;
use crate::variants::variants;

variants! {
    "empty/f32/none/10000" => Empty,
    "placeholder/f32/rigid/10000" => placeholder::Single,
    "placeholder/fixed/rigid/10000" => placeholder::Fixed,
}
