//! An empty scene: the cost of the loop itself, and the reference for every other scene's image.

use crate::scene::table::variants;
use crate::scene::{Input, Output, Scene, Variant};

/// No drive at all.
pub struct Empty;

impl Scene for Empty {
    fn tick(&mut self, _: &Input) -> Output {
        Output::default()
    }
}

impl Variant for Empty {
    type Scene = Empty;
    const NAME: &'static str = "empty/f32/none/10000";
    const RATE_HZ: u32 = 10_000;

    fn start() -> Empty {
        Empty
    }
}

variants! { Empty }
