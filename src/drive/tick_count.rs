//! Ticks that did not run, from a count in the sample.

/// The count that the next sample should have.
///
/// A counter of the timer's periods, or of the samples of a bus, goes on while a tick is missed. Its value with each
/// sample tells a drive how many ticks did not run: for [`Drive::tick_after`](super::Drive::tick_after). A clock that
/// jitters does not matter, as it counts once a period. A time stamp is for
/// [`MissedTicks`](crate::axis::MissedTicks).
///
/// ```
/// use driveline::drive::TickCount;
///
/// let mut count = TickCount::default();
/// let missed = [65_534, 65_535, 0, 3, 3, 4].map(|counted| count.missed(counted));
/// // two ticks did not run before the fourth sample, and the fifth is the same again
/// assert_eq!(missed, [0, 0, 0, 2, 0, 0]);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TickCount {
    next: Option<u16>,
}

impl TickCount {
    /// Ticks that did not run before the sample with this count, up to 32,767; a count that has gone back is none.
    #[inline]
    pub fn missed(&mut self, count: u16) -> u32 {
        let missed = self.next.map_or(0, |next| count.wrapping_sub(next));
        self.next = Some(count.wrapping_add(1));
        if missed > u16::MAX >> 1 { 0 } else { missed.into() }
    }
}
