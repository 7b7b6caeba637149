//! A drive with any governor as a scene.

use driveline::drive::{ConfigOf, Drive};
use driveline::governor::Governor;
use driveline::number::Number;
use driveline::observer::Observer;

use crate::scene::expected::Expected;
use crate::scene::governed::advance;
use crate::scene::{Input, Output, Scene};

/// The parts and constants of one variant of a scene.
pub trait Parts: 'static {
    /// What it calculates with.
    type Number: Number + 'static;
    /// What it estimates with.
    type Observer: Observer<Self::Number>;
    /// What it governs with.
    type Governor: Governor<Self::Number>;
    /// Scene, number, variant and rate.
    const NAME: &'static str;
    /// Ticks a second.
    const RATE_HZ: u32;
    /// The drive's constants.
    const CONFIG: &'static ConfigOf<Drive<Self::Number, Self::Observer, (), Self::Governor>>;

    /// What the observer's design says of its errors, as [`Scene::expected`].
    fn expected() -> Option<Expected> {
        None
    }
}

/// A drive with its constants.
///
/// While the governor is not released, [`Input::reference`] is the torque that the drive holds.
pub struct Assembled<P: Parts> {
    // By reference: folded into the code, the constants cost more instructions than loaded from a table.
    config: &'static ConfigOf<Drive<P::Number, P::Observer, (), P::Governor>>,
    drive: Drive<P::Number, P::Observer, (), P::Governor>,
}

impl<P: Parts> Scene for Assembled<P> {
    const NAME: &'static str = P::NAME;
    const RATE_HZ: u32 = P::RATE_HZ;

    fn expected() -> Option<Expected> {
        P::expected()
    }

    fn new() -> Self {
        Assembled { config: P::CONFIG, drive: Drive::new(P::CONFIG, 0) }
    }

    #[inline(always)]
    fn tick(&mut self, input: &Input) -> Output {
        advance(&mut self.drive, self.config, input)
    }
}
