//! Ticks that did not run, counted from a time.

/// Counts ticks that did not run, from the time at each tick: a free-running timer read at the start of the tick, or
/// the sample's own time stamp.
///
/// A tick runs late, where another interrupt holds it up, and never early: the earliest ones show when ticks are due.
/// Up to three quarters of a period after its time a tick counts as late; after that, the one before it did not run.
/// The timer may be slower or faster than the tick's by 1 %.
///
/// ```
/// use driveline::axis::MissedTicks;
/// // a timer of 16 bits and 1 MHz, read in a tick of 100 us: in time, late by 30 us, after two that did not run
/// let mut missed = MissedTicks::new(100, 16);
/// assert_eq!([65_500, 64, 194, 464].map(|now| missed.count(now)), [0, 0, 0, 2]);
/// ```
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct MissedTicks {
    /// Counts of a tick.
    period: u32,
    /// The largest count.
    largest: u32,
    /// When the next tick is due.
    due: Option<u32>,
}

impl MissedTicks {
    /// A time of `bits` bits that advances by `period` counts a tick, whatever its unit.
    ///
    /// # Panics
    /// Where `bits` is not within 8 to 32, or a period is not within 4 counts and a quarter of the time's range; in a
    /// constant at compile time.
    pub const fn new(period: u32, bits: u32) -> Self {
        assert!(bits >= 8 && bits <= 32, "a time must have between 8 and 32 bits");
        let largest = u32::MAX >> (32 - bits);
        assert!(
            period >= 4 && period <= largest / 4,
            "the period of a tick must be from 4 counts to a quarter of the range of its time"
        );
        MissedTicks { period, largest, due: None }
    }

    /// Ticks that did not run between the last call and this one, at the time `now`. A gap as long as the range of the
    /// time, less a period, is not seen.
    #[inline]
    pub fn count(&mut self, now: u32) -> u32 {
        let due = self.due.unwrap_or(now);
        let late = now.wrapping_sub(due) & self.largest;
        let mut missed: u32 = 0;
        let mut begins = now;
        // beyond that it is early
        if late <= self.largest.wrapping_sub(self.period) {
            let quarter = self.period >> 2;
            let mut rest = late;
            if late >= self.period.wrapping_sub(quarter) {
                missed = late.wrapping_add(quarter).checked_div(self.period).unwrap_or(0);
                rest = late.wrapping_sub(missed.wrapping_mul(self.period));
            }
            if rest < self.period {
                begins = now.wrapping_sub(rest).wrapping_add(rest >> 4);
            }
        }
        self.due = Some(begins.wrapping_add(self.period));
        missed
    }
}
