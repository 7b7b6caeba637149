//! A ticking scene: on the host, or an image in QEMU.

use std::io;

use driveline_firmware::scene::{Input, Output, Scene};
use driveline_qemu::link::Link;

/// Something that ticks: a scene on the host, or an image in QEMU.
pub trait Ticks {
    /// One tick.
    fn tick(&mut self, input: &Input) -> io::Result<Output>;
}

/// A scene on the host.
pub struct OnHost<S>(pub S);

impl<S: Scene> Ticks for OnHost<S> {
    fn tick(&mut self, input: &Input) -> io::Result<Output> {
        Ok(self.0.exchange(input))
    }
}

impl<T: Ticks + ?Sized> Ticks for Box<T> {
    fn tick(&mut self, input: &Input) -> io::Result<Output> {
        (**self).tick(input)
    }
}

impl Ticks for Link {
    fn tick(&mut self, input: &Input) -> io::Result<Output> {
        self.exchange(input)
    }
}
