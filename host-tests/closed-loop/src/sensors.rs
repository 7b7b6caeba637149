//! The drive's sensors: an incremental encoder.

use core::f64::consts::TAU;

/// An encoder that counts from where it was switched on.
#[derive(Clone, Copy, Debug)]
pub struct Encoder {
    counts: f64,
}

impl Encoder {
    /// An encoder of so many counts a turn.
    pub fn new(counts: u32) -> Self {
        Encoder { counts: f64::from(counts) }
    }

    /// Lines on a turn, of four counts each.
    pub fn lines(&self) -> f64 {
        0.25 * self.counts
    }

    /// The angle as the drive reads it, 2^32 per turn: the count that `angle` (rad) lies in.
    pub fn read(&self, angle: f64) -> u32 {
        let count = (angle / TAU * self.counts).floor();
        let turn = (count / self.counts).rem_euclid(1.0);
        // A turn rounds up to 2^32 only from 1 - 2^-53, which a count of at most 2^31 a turn does not reach.
        (turn * 4_294_967_296.0) as u64 as u32
    }
}
