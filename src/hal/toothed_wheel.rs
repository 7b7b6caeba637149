//! The angle from a toothed wheel with missing teeth, by the times of its teeth.
//!
//! The timer's capture interrupt records each tooth's time; the tick reads the angle at its own. Between two teeth the
//! angle runs on at the speed of the last tooth, and not beyond the next one. One pickup does not see the direction:
//! the wheel counts upwards.
//!
//! The place is known once two gaps with the right number of teeth between them have been seen, and is checked at every
//! gap: a tooth too many or too few loses it until two gaps agree again. A tooth that comes early by a quarter of its
//! time, or stays away for half of it, loses it at once; one that is less off moves the angle by as much, up to the
//! next gap.

use super::AngleSensor;
use crate::fault::Faults;

/// A wheel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Wheel {
    /// Places for teeth, the missing ones included: 60 of a 60-2 wheel.
    pub places: u32,
    /// Missing teeth, side by side: 2 of a 60-2 wheel.
    pub missing: u32,
    /// Longest plausible time between two teeth [counts of the timer]: below that speed there is no angle.
    pub slowest: u32,
}

/// Known position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
enum Known {
    /// No tooth yet.
    Nothing,
    /// One tooth: its time.
    Tooth,
    /// The time between two teeth.
    Period,
    /// Teeth since a gap, which may have been a lost tooth.
    Counting(u32),
    /// The place of the last tooth.
    Place(u32),
}

/// A toothed wheel. The angle is zero at the first tooth behind the gap.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ToothedWheel {
    wheel: Wheel,
    /// 2^32 over the places.
    pitch: u32,
    known: Known,
    last: u32,
    period: u32,
}

impl ToothedWheel {
    /// A wheel that has not turned yet.
    ///
    /// # Panics
    /// Where it has no missing tooth, or not at least four more teeth than missing ones; in a constant at compile time.
    pub const fn new(wheel: Wheel) -> Self {
        assert!(wheel.missing >= 1 && wheel.missing <= 1000, "a wheel must have at least one missing tooth");
        assert!(
            wheel.places >= 2 * wheel.missing + 4 && wheel.places <= 10_000,
            "a wheel must have at least four more teeth than missing ones"
        );
        assert!(wheel.slowest > 0 && wheel.slowest < 1 << 31, "the longest time between two teeth must be positive");
        let pitch = ((1 << 32) / wheel.places as u64) as u32;
        ToothedWheel { wheel, pitch, known: Known::Nothing, last: 0, period: 0 }
    }

    /// A tooth at `time`, in the counts of a timer of 32 bits that wraps.
    pub fn tooth(&mut self, time: u32) {
        let elapsed = time.wrapping_sub(self.last);
        self.last = time;
        let too_slow = elapsed > self.wheel.slowest.saturating_mul(self.wheel.missing + 1) || elapsed == 0;
        let gap = self.is_gap(elapsed);
        let before_gap = self.before_gap();
        self.known = match self.known {
            Known::Nothing => Known::Tooth,
            _ if too_slow => Known::Tooth,
            Known::Tooth => Known::Period,
            Known::Counting(place) | Known::Place(place) if place == before_gap && gap => Known::Place(0),
            _ if gap => Known::Counting(0),
            Known::Period => Known::Period,
            _ if !self.is_regular(elapsed) => Known::Period,
            Known::Counting(place) if place < before_gap => Known::Counting(place + 1),
            Known::Place(place) if place < before_gap => Known::Place(place + 1),
            Known::Counting(_) | Known::Place(_) => Known::Period,
        };
        // the gap's mean is a period, too; a speed that changes much within a gap is no machine's
        self.period = if matches!(self.known, Known::Counting(0) | Known::Place(0)) {
            elapsed / (self.wheel.missing + 1)
        } else {
            elapsed
        };
    }

    /// The angle at `now`, in the counts of the same timer; a time before the last tooth counts as the tooth's. To be
    /// read in every tick, so that a stopped wheel is not taken for one that has just turned once.
    ///
    /// # Errors
    /// [`Faults::ANGLE_MISSING`] where the place is not known, a tooth is overdue by half its time, or the wheel is too
    /// slow.
    pub fn at(&mut self, now: u32) -> Result<u32, Faults> {
        let Known::Place(place) = self.known else {
            return Err(Faults::ANGLE_MISSING);
        };
        let elapsed = (now.wrapping_sub(self.last) as i32).max(0) as u32;
        let teeth = if place == self.before_gap() { self.wheel.missing + 1 } else { 1 };
        let due = self.period.saturating_mul(teeth);
        if elapsed > due.saturating_add(due / 2) || self.period > self.wheel.slowest {
            // the next tooth is the first
            self.known = Known::Nothing;
            return Err(Faults::ANGLE_MISSING);
        }
        let span = self.pitch as u64 * teeth as u64;
        let run = (span * elapsed.min(due) as u64).checked_div(due as u64).unwrap_or(0);
        // the sum passes 2^32 where the wheel comes round
        Ok((place as u64 * self.pitch as u64).wrapping_add(run) as u32)
    }

    /// The place of the last tooth before the gap.
    fn before_gap(&self) -> u32 {
        self.wheel.places - self.wheel.missing - 1
    }

    /// Whether a time is that of a gap: more than half of the missing teeth longer than the last tooth's.
    fn is_gap(&self, elapsed: u32) -> bool {
        // period (1 + missing/2) < elapsed
        2 * elapsed as u64 > (self.wheel.missing + 2) as u64 * self.period as u64 && self.period > 0
    }

    /// Whether a time that is no gap's is a tooth's: within three quarters and one and a half of the last one's.
    fn is_regular(&self, elapsed: u32) -> bool {
        4 * elapsed as u64 >= 3 * self.period as u64 && 2 * elapsed as u64 <= 3 * self.period as u64
    }
}

/// The wheel at a time, as a sensor: `(wheel, now)`.
impl AngleSensor for (&mut ToothedWheel, u32) {
    fn angle(&mut self) -> Result<u32, Faults> {
        self.0.at(self.1)
    }
}
