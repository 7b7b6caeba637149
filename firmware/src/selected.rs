//! The variants that can be flashed, and the one that this image holds.
//!
//! One line a variant: its name (the scene's [`Scene::NAME`](crate::scene::Scene::NAME): scene, number, observer,
//! ticks a second) and its type. `DRIVELINE_VARIANT` chooses the line at build time; [`Selected`] is the type.

use crate::scenes::empty::Empty;
use crate::scenes::{hoist, placeholder};
use crate::variants::variants;

variants! {
    "empty/f32/none/10000" => Empty,
    "hoist/f32/rigid/1000" => hoist::RigidSingle1000,
    "hoist/f32/cut/1000" => hoist::CutSingle1000,
    "hoist/f32/exact/1000" => hoist::ExactSingle1000,
    "hoist/f32/reduced/1000" => hoist::ReducedSingle1000,
    "hoist/fixed/rigid/1000" => hoist::RigidFixed1000,
    "hoist/fixed/cut/1000" => hoist::CutFixed1000,
    "hoist/fixed/exact/1000" => hoist::ExactFixed1000,
    "hoist/fixed/reduced/1000" => hoist::ReducedFixed1000,
    "hoist/f32/rigid/4000" => hoist::RigidSingle4000,
    "hoist/f32/cut/4000" => hoist::CutSingle4000,
    "hoist/f32/exact/4000" => hoist::ExactSingle4000,
    "hoist/f32/reduced/4000" => hoist::ReducedSingle4000,
    "hoist/fixed/rigid/4000" => hoist::RigidFixed4000,
    "hoist/fixed/cut/4000" => hoist::CutFixed4000,
    "hoist/fixed/exact/4000" => hoist::ExactFixed4000,
    "hoist/fixed/reduced/4000" => hoist::ReducedFixed4000,
    "hoist/f32/rigid/10000" => hoist::RigidSingle10000,
    "hoist/f32/cut/10000" => hoist::CutSingle10000,
    "hoist/f32/exact/10000" => hoist::ExactSingle10000,
    "hoist/f32/reduced/10000" => hoist::ReducedSingle10000,
    "hoist/fixed/rigid/10000" => hoist::RigidFixed10000,
    "hoist/fixed/cut/10000" => hoist::CutFixed10000,
    "hoist/fixed/exact/10000" => hoist::ExactFixed10000,
    "hoist/fixed/reduced/10000" => hoist::ReducedFixed10000,
    "placeholder/f32/rigid/10000" => placeholder::Single,
    "placeholder/fixed/rigid/10000" => placeholder::Fixed,
}
