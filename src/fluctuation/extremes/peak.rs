//! An extreme of a speed as the tick keeps it, compared as integers.

use crate::number::{Fixed, Number};

/// Comparison as integers, beside the operations of [`Number`].
pub trait Ranked: Number {
    /// The number as an integer that rises with it among numbers of one sign; that of a float below zero falls.
    type Rank: Copy + Default + Ord + core::fmt::Debug;
    /// The number as an integer to be compared with others of its sign; that of a NaN is beyond infinity.
    fn rank(self) -> Self::Rank;
    /// The number of a rank.
    fn of_rank(rank: Self::Rank) -> Self;
}

// The bits of a float without the sign rise with the magnitude.
macro_rules! ranked {
    ($number:ident, $rank:ident) => {
        impl Ranked for $number {
            type Rank = $rank;

            #[inline(always)]
            fn rank(self) -> $rank {
                self.to_bits() as $rank
            }

            #[inline(always)]
            fn of_rank(rank: $rank) -> Self {
                $number::from_bits(rank as _)
            }
        }
    };
}

ranked!(f32, i32);
ranked!(f64, i64);
ranked!(Fixed, i32);

/// An extreme as the tick keeps it: three samples, and where the last of them was.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Peak<R> {
    pub(super) value: R,
    /// The extreme before: on the way to a peak, the sample before.
    pub(super) before: R,
    pub(super) after: R,
    /// The angle (2^-32 turn), its last six bits those of the segment's number.
    pub(super) place: u32,
}

/// Bits of a place that are the segment's.
pub(super) const SEGMENTS: u32 = 63;

/// The angle and the segment in one.
#[inline(always)]
pub(super) fn place(angle: u32, segment: u32) -> u32 {
    (angle & !SEGMENTS) | (segment & SEGMENTS)
}

/// The extremes of one speed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Speed<R> {
    pub(super) last: R,
    pub(super) max: Peak<R>,
    pub(super) min: Peak<R>,
}

impl<R: Copy + Ord> Speed<R> {
    #[inline(always)]
    pub(super) fn follow(&mut self, value: R, place: impl Fn() -> u32) {
        let middle = core::mem::replace(&mut self.last, value);
        if middle > self.max.value {
            self.max = Peak { value: middle, before: self.max.value, after: value, place: place() };
        } else if middle < self.min.value {
            self.min = Peak { value: middle, before: self.min.value, after: value, place: place() };
        }
    }

    /// Start of the next cycle: the last speed.
    #[inline(always)]
    pub(super) fn fresh(&self, place: u32) -> Peak<R> {
        Peak { value: self.last, before: self.last, after: self.last, place }
    }
}
