//! The worst of a variant's built-in inputs, far more of them than a self-test has.

use std::error::Error;

use driveline_firmware::self_test::fingerprint::SEED;
use driveline_firmware::self_test::inputs::Program as Inputs;

use crate::image::Image;
use crate::link::Link;

use super::cost::variant;

/// Inputs that are exchanged at once.
const ROUND: usize = 1024;

/// The most instructions of so many ticks.
pub fn worst_drawn(image: &Image, ticks: usize) -> Result<u32, Box<dyn Error>> {
    let mut drawn = Inputs::new(SEED, variant(image)?.words());
    let (mut link, mut most) = (Link::start(image)?, 0);
    for first in (0..ticks).step_by(ROUND) {
        let inputs: Vec<_> = (first..ticks.min(first + ROUND)).map(|_| drawn.next_input()).collect();
        let outputs = link.exchange_all(&inputs)?;
        most = outputs.iter().fold(most, |most, output| most.max(output.instructions));
    }
    link.finish()?;
    Ok(most)
}
