//! Smoothed passage and speed of the wheel.

use super::description::Tooth;

/// Corrections of the passage and of the time of a span by the error of a passage [2^-8], from the fastest to the
/// smoothest: optimal for a speed that changes at random beside a jitter of the edges, for one ratio of the two each
/// (P. Kalata, The tracking index, IEEE Trans. AES 20, 1984: b = 2 (2 - a) - 4 sqrt(1 - a)). The first takes the last
/// interval alone.
const GAINS: [[i32; 2]; 5] = [[256, 256], [192, 128], [128, 44], [64, 9], [32, 2]];

/// Sign of an error [2^-5] and the part of its mean that a new one replaces.
const SIGN: i32 = 32;
const MEMORY: u32 = 4;

/// Mean product of two successive signs at which the gains are changed.
const CHANGE: i32 = 160;

/// The passage and the speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Track {
    /// When the last tooth passed (clock counts), smoothed.
    pub passage: u32,
    /// Time of a turn (clock counts), smoothed; 0 for none.
    pub turn: u32,
    /// The same, at the highest speed of late: it follows a slower one by 1/64 a tooth. While the place is not
    /// known, the shortest interval.
    pub pace: u32,
    /// Which of the gains.
    gain: u32,
    /// The last error, and the mean product of successive signs.
    pub error: i32,
    product: i32,
    /// Mean size of the errors [2^-4 clock].
    size: u32,
}

impl Track {
    pub const NEW: Track = Track { passage: 0, turn: 0, pace: 0, gain: 0, error: 0, product: 0, size: 0 };

    /// From the last two intervals, and the teeth that they ended at.
    pub fn begin(interval: u32, before: u32, time: u32, tooth: &Tooth, last: &Tooth) -> Track {
        let turn = |interval: u32, tooth: &Tooth| (u64::from(interval) * u64::from(tooth.spans)) >> 12;
        let turn = (turn(interval, tooth) + turn(before, last)) / 2;
        let turn = turn as u32;
        // Until there are errors: a sixth of a pitch.
        let begun = Track { passage: time, turn, pace: turn, gain: 1, ..Track::NEW };
        Track { size: (begun.time_of(tooth.slack) / 3) << 4, ..begun }
    }

    /// The time of a part of a turn.
    pub fn time_of(&self, angle: u32) -> u32 {
        ((u64::from(angle) * u64::from(self.turn)) >> 32) as u32
    }

    /// An edge by so much later than the passage expected.
    pub fn correct(&mut self, expected: u32, error: i32, tooth: &Tooth, slowest: u32) {
        let [of_passage, of_span] = GAINS.get(self.gain as usize).copied().unwrap_or([256, 256]);
        self.passage = expected.wrapping_add(((i64::from(error) * i64::from(of_passage)) >> 8) as u32);
        let turn =
            i64::from(self.turn) + ((i64::from(error) * i64::from(of_span.wrapping_mul(tooth.spans as i32))) >> 20);
        self.turn = if turn > 0 && turn < i64::from(slowest) { turn as u32 } else { 0 };
        let pace = self.pace.wrapping_add(self.pace >> 6);
        self.pace = if self.turn < pace { self.turn } else { pace };
        self.size = self.size.wrapping_add(error.unsigned_abs()).wrapping_sub(self.size >> 4);
        if error != 0 && self.error != 0 {
            let sign = ((error ^ self.error) >> 31) | 1;
            self.product = self.product.wrapping_add(sign * SIGN).wrapping_sub(self.product >> MEMORY);
            if self.product > CHANGE {
                self.gain = self.gain.saturating_sub(1);
                self.product = 0;
            } else if self.product < -CHANGE {
                self.gain = if self.gain < 4 { self.gain + 1 } else { 4 };
                self.product = 0;
            }
        }
        self.error = error;
    }

    /// Whether the speed has fallen to less than half of that of late. A machine that turns back has passed its last
    /// tooth so slowly: under a constant torque from N pitches before, at most by 1/sqrt(2 N) of its speed there.
    pub fn has_slowed(&self) -> bool {
        self.turn >> 1 > self.pace
    }

    /// Whether the speed is within a quarter of that of late.
    pub fn is_steady(&self) -> bool {
        self.turn.wrapping_sub(self.turn >> 2) < self.pace
    }

    /// By how much an edge may be early and late to be a tooth, from half a pitch and the span's time (clock counts):
    /// five times the errors' mean size, between 0.3 and 0.75 pitches; behind a gap twice as much, up to a quarter of
    /// its time. A late edge within half a pitch has no tooth nearer.
    pub fn window(&self, half: i32, span: u32) -> [i32; 2] {
        let size = (self.size >> 4).saturating_mul(5).min(i32::MAX as u32 >> 1) as i32;
        let most = half.wrapping_add(half >> 1);
        let gap = (size << 1).min((span >> 2) as i32);
        let early = size.min(most).max((half >> 1).wrapping_add(half >> 3)).max(gap);
        [early, early.max(half)]
    }

    /// Standard deviation of the angle as a time (clock counts): 5/4 of the errors' mean size, as normal errors
    /// have it, and the square root of the passage's gain of it.
    pub fn deviation(&self) -> u32 {
        const ROOTS: [u32; 5] = [20, 17, 14, 10, 7];
        let root = ROOTS.get(self.gain as usize).copied().unwrap_or(20);
        (self.size >> 4).saturating_mul(root) >> 4
    }

    /// From times to angles.
    pub fn scale(&self) -> Scale {
        let zeros = self.turn.leading_zeros();
        let mantissa = (self.turn << (zeros & 31)) >> 16;
        Scale { zeros, inverse: u32::MAX.checked_div(mantissa).unwrap_or(0) }
    }
}

/// Angle of a time: 2^32 over the turn's time, as a mantissa and a power of two.
#[derive(Clone, Copy)]
pub(super) struct Scale {
    zeros: u32,
    inverse: u32,
}

impl Scale {
    /// The angle of a time (2^-32 turn).
    pub fn angle(&self, time: i32) -> u32 {
        ((i64::from(time) << (self.zeros & 31)).wrapping_mul(i64::from(self.inverse)) >> 16) as u32
    }
}
