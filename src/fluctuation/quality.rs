//! How far a ripple can be relied on, and why a window cannot be used.

use core::fmt;

/// Quality of a ripple.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Quality<R = f64> {
    /// Rms of the angle that the orders leave unexplained (rad): higher orders, pitch errors, jitter's mean.
    pub residue: R,
    /// Rms of the angle by which single cycles differ from their mean (rad); 0 where only the mean is known, as of a
    /// waveform from ticks.
    pub spread: R,
    /// Relative rise of a cycle's duration from one cycle to the next, which was taken off.
    pub trend: R,
    /// Cycles that were not taken between the window's first and last.
    pub missed: u32,
}

/// Why a window gives no ripple.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Unusable {
    /// No cycle was added.
    NoCycle,
    /// A tooth is out of place by more than the orders and half the least of its spans explain.
    Teeth,
    /// The speed changes by more than a tenth from one cycle to the next, or the motor stops or turns back.
    Trend,
    /// Too few ticks to a cycle: fewer than 12 to a quarter of a turn, or to the segment that the cycle is in. Fewer
    /// than 18 to a quarter of a turn where a cycle is not a turn, or the window has fewer than eight cycles.
    Ticks,
}

impl Unusable {
    /// Largest relative rise of a cycle's duration.
    pub(super) const RISE: f64 = 0.1;
    /// Largest part of a tooth's slack that may be unexplained.
    pub(super) const TOOTH: f64 = 0.7;
    /// Fewest ticks to a segment of the cycle: 24 pass at the end of a cycle, in which the motor may turn by two.
    pub(super) const TICKS: f64 = 12.0;
    /// Fewest ticks to a turn where its half is not the other half of the cycle: 30 pass between the end of a cycle and
    /// that of its first segment being noticed, in which the motor must turn by less than half a turn; with a fifth of
    /// the speed to spare. In a window of few cycles the ripple that is sought hides the place of its ends.
    pub(super) const OF_A_TURN: f64 = 72.0;

    /// The sentence.
    pub const fn message(&self) -> &'static str {
        match self {
            Unusable::NoCycle => "the window has no cycle: add at least one",
            Unusable::Teeth => "a tooth is out of place by more than the orders explain: check the wheel's description",
            Unusable::Trend => {
                "the speed changes by more than a tenth in a cycle: hold it, or take fewer turns to a cycle"
            }
            Unusable::Ticks => {
                "a quarter of a turn has fewer than 12 ticks, or 18 where the cycle is not a turn or there are fewer \
                than eight cycles: raise the rate of the ticks, or take the times of teeth"
            }
        }
    }
}

impl fmt::Display for Unusable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.message())
    }
}

impl core::error::Error for Unusable {}
