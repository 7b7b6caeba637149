//! The place of a tooth from the ratios of successive intervals.

/// Steps of the logarithm of a ratio to the octave, as a power of two.
const STEPS: u32 = 3;

/// Ratios that are told apart: from 1/8 to 8.
pub(crate) const RATIOS: usize = 6 << STEPS | 1;

/// Most teeth that the wheel, or the part of it that repeats, may have.
pub(crate) const MOST: usize = 128;

pub(crate) type Set = [u64; 2];

/// Logarithm of an interval to base 2, in eighths: exact at powers of two, and at most 0.21 too low between them.
const fn logarithm(interval: u32) -> i32 {
    let interval = if interval == 0 { 1 } else { interval };
    let zeros = interval.leading_zeros();
    let mantissa = (interval << zeros) >> (31 - STEPS) & ((1 << STEPS) - 1);
    (((31 - zeros) << STEPS) + mantissa) as i32
}

/// The number of a ratio of two intervals.
pub(crate) const fn ratio(interval: u32, before: u32) -> usize {
    let step = logarithm(interval) - logarithm(before) + (3 << STEPS);
    if step < 0 {
        0
    } else if step as usize >= RATIOS {
        RATIOS - 1
    } else {
        step as usize
    }
}

/// The middle of a number's ratios (octave).
pub(crate) const fn ratio_of(number: usize) -> f64 {
    (number as f64 - (3 << STEPS) as f64) / (1 << STEPS) as f64
}

/// Places at which the last tooth may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Search {
    /// Those that are left.
    left: Set,
    /// Intervals since it began.
    pub(super) intervals: u32,
}

impl Search {
    /// Anywhere.
    pub(super) const NEW: Search = Search { left: [u64::MAX; 2], intervals: 0 };

    /// Goes to the next of `teeth` teeth, which must be one of `fitting`; where none is, begins anew with these.
    pub(super) fn advance(&mut self, fitting: &Set, teeth: u32) {
        let [low, high] = self.left;
        let wrapped =
            if teeth <= 64 { low >> (teeth.wrapping_sub(1) & 63) } else { high >> (teeth.wrapping_sub(65) & 63) };
        let next = [low << 1 | wrapped & 1, high << 1 | low >> 63];
        // The sets of `fitting` have no tooth beyond the last.
        self.left = [next[0] & fitting[0], next[1] & fitting[1]];
        self.intervals = self.intervals.saturating_add(1);
        if self.left[0] | self.left[1] == 0 {
            *self = Search { left: *fitting, intervals: 1 };
        }
    }

    /// The place, where only one is left.
    pub(super) fn found(&self) -> Option<u32> {
        match self.left {
            [low, 0] if low.is_power_of_two() => Some(low.trailing_zeros()),
            [0, high] if high.is_power_of_two() => Some(64 + high.trailing_zeros()),
            _ => None,
        }
    }
}
