//! The tick of the selected scene as a function of its own, so that its code and instructions can be measured.

use crate::scene::{Input, Output, Scene};
use crate::selected::Selected;

/// One tick of the scene that this image holds.
#[unsafe(no_mangle)]
#[unsafe(link_section = ".text.driveline_tick")]
#[inline(never)]
pub extern "Rust" fn driveline_tick(scene: &mut Selected, input: &Input, output: &mut Output) {
    *output = scene.tick(input);
}
