//! A scene that does nothing: what the loop itself costs, and what every other scene's image is compared with.

use crate::scene::{Input, Output, Scene};

/// No drive at all.
pub struct Empty;

impl Scene for Empty {
    const NAME: &'static str = "empty/f32/none/10000";
    const RATE_HZ: u32 = 10_000;

    fn new() -> Self {
        Empty
    }

    fn tick(&mut self, _: &Input) -> Output {
        Output::default()
    }
}
