//! Correlation of angle and torque with orders of the motor's turn: where an eccentric encoder shows, and beside it.

use crate::angle::Synchronous;

/// Orders that are correlated with, in halves: beside, at, and beyond that of an eccentricity.
pub(crate) const HALVES: [u32; 3] = [1, 2, 3];

/// Sums of one order: speed and torque times cosine and sine.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Harmonic {
    pub speed: [f32; 2],
    pub torque: [f32; 2],
}

impl Harmonic {
    /// Takes in a block at an angle of `halves` half turns of the motor's `angle` (2^-32 turn).
    #[inline(always)]
    pub(crate) fn take(&mut self, halves: u32, angle: i64, window: f32, speed: f32, torque: f32) {
        // The table takes 2^26 to the turn.
        let place = ((angle * i64::from(halves)) >> 1) as u32 >> 6;
        let [cosine, sine] = <f32 as Synchronous>::direction(place);
        let (cosine, sine) = (window * cosine, -window * sine);
        self.speed = [self.speed[0] + speed * cosine, self.speed[1] + speed * sine];
        self.torque = [self.torque[0] + torque * cosine, self.torque[1] + torque * sine];
    }
}
