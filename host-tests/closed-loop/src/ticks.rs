//! A ticking scene: on the host, or an image in QEMU.

use std::io;

use driveline_firmware::scene::{Input, Output, Scene};
use driveline_qemu::link::Link;

/// Something that ticks: a scene on the host, or an image in QEMU.
pub trait Ticks {
    /// One tick.
    fn tick(&mut self, input: &Input) -> io::Result<Output>;

    /// So many ticks did not run before the one with this input. Returns the faults to add to those of that tick.
    fn missed(&mut self, _input: &Input, _ticks: u32) -> u32 {
        0
    }
}

/// A scene on the host.
pub struct OnHost<S>(pub S);

impl<S: Scene> Ticks for OnHost<S> {
    fn tick(&mut self, input: &Input) -> io::Result<Output> {
        Ok(self.0.exchange(input))
    }

    fn missed(&mut self, input: &Input, ticks: u32) -> u32 {
        self.0.missed(input, ticks)
    }
}

impl<T: Ticks + ?Sized> Ticks for Box<T> {
    fn tick(&mut self, input: &Input) -> io::Result<Output> {
        (**self).tick(input)
    }

    fn missed(&mut self, input: &Input, ticks: u32) -> u32 {
        (**self).missed(input, ticks)
    }
}

impl Ticks for Link {
    fn tick(&mut self, input: &Input) -> io::Result<Output> {
        self.exchange(input)
    }
}
