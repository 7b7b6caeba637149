//! Rainflow counting on the tick.

use super::{Classed, Counts, TorqueClasses};
use crate::fluctuation::Fluctuation;
use crate::sample::Estimate;

/// Places before the residue.
const UNUSED: u32 = 2;

/// Rainflow counting of the shaft torque in `CLASSES` classes. `REVERSALS` is a power of two with room for the longest
/// residue: twice the classes and four.
///
/// A tick does one step of the four-point method, and a reversal needs one and a half of them on average. So none is
/// lost where reversals are two ticks apart; [`Counts::lost`] counts those that were.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Rainflow<N, const CLASSES: usize, const REVERSALS: usize> {
    /// The present half cycle's end as far as it is known, and the way to it: 1, -1, or 0 at the start.
    last: i32,
    way: i32,
    /// The residue behind two places that are not used, and its last four reversals, the latest in the lowest byte.
    residue: [u8; REVERSALS],
    length: u32,
    four: u32,
    /// Reversals that wait, a ring.
    queue: [u8; REVERSALS],
    first: u32,
    next: u32,
    /// Reversals for which there was no place.
    lost: u32,
    /// Cycles by their range in classes.
    cycles: [u32; CLASSES],
    /// Ticks in each class.
    ticks: [u32; CLASSES],
    /// The largest torque, either way.
    largest: N,
}

impl<N: Classed, const CLASSES: usize, const REVERSALS: usize> Default for Rainflow<N, CLASSES, REVERSALS> {
    fn default() -> Self {
        const {
            assert!(
                REVERSALS.is_power_of_two() && REVERSALS >= 2 * CLASSES + 4,
                "the reversals must be a power of two, and twice the classes and four at least"
            );
        }
        Rainflow {
            last: i32::MIN,
            way: 0,
            residue: [0; REVERSALS],
            length: UNUSED,
            four: 0,
            queue: [0; REVERSALS],
            first: 0,
            next: 0,
            lost: 0,
            cycles: [0; CLASSES],
            ticks: [0; CLASSES],
            largest: N::ZERO,
        }
    }
}

impl<N: Classed, const CLASSES: usize, const REVERSALS: usize> Fluctuation<N> for Rainflow<N, CLASSES, REVERSALS> {
    type Config = TorqueClasses<N>;

    #[inline(always)]
    fn measure(&mut self, config: &TorqueClasses<N>, _angle: u32, _torque: N, estimate: &Estimate<N>) {
        let torque = estimate.shaft_torque;
        if torque.exceeds(self.largest) {
            self.largest = torque.magnitude();
        }
        let class = torque.classes(config.scale).wrapping_add(config.middle);
        let top = const { CLASSES as i32 - 1 };
        let class = if class < 0 {
            0
        } else if class > top {
            top
        } else {
            class
        };
        if let Some(ticks) = self.ticks.get_mut(class as usize) {
            *ticks = ticks.wrapping_add(1);
        }
        self.step();
        self.follow(class);
    }

    /// The torque is an estimate by prediction then, and counts as such.
    #[inline(always)]
    fn disturb(&mut self) {}
}

impl<N: Classed, const CLASSES: usize, const REVERSALS: usize> Rainflow<N, CLASSES, REVERSALS> {
    /// Follows the torque to a class; where it turns round its last class is a reversal.
    #[inline(always)]
    fn follow(&mut self, class: i32) {
        let last = self.last;
        if class == last {
            return;
        }
        self.last = class;
        if last < 0 {
            return;
        }
        let way = if class > last { 1 } else { -1 };
        if way != self.way {
            self.way = way;
            self.put(last as u8);
        }
    }

    /// A reversal into the queue.
    #[inline(always)]
    fn put(&mut self, reversal: u8) {
        let next = self.next;
        if next.wrapping_sub(self.first) == REVERSALS as u32 {
            self.lost = self.lost.saturating_add(1);
        } else if let Some(place) = self.queue.get_mut(next as usize & (REVERSALS - 1)) {
            *place = reversal;
            self.next = next.wrapping_add(1);
        }
    }

    /// The last four reversals of the residue, and the range of the middle two where they are a cycle.
    #[inline(always)]
    fn closed(&self) -> Option<(usize, u8)> {
        let [before, one, other, after] = self.four.to_be_bytes();
        let inner = one.abs_diff(other);
        let is_cycle = inner <= before.abs_diff(one) && inner <= other.abs_diff(after);
        (is_cycle && self.length > UNUSED + 3).then_some((inner.into(), after))
    }

    /// One step of the four-point method: counts a cycle, or takes a reversal from the queue.
    #[inline(always)]
    fn step(&mut self) {
        if let Some((inner, after)) = self.closed() {
            if let Some(cycles) = self.cycles.get_mut(inner) {
                *cycles = cycles.wrapping_add(1);
            }
            self.length = self.length.wrapping_sub(2);
            let at = self.length as usize;
            if let Some([rest @ .., last]) = self.residue.get_mut(at.wrapping_sub(4)..at) {
                *last = after;
                if let &mut [a, b, c] = rest {
                    self.four = u32::from_be_bytes([a, b, c, after]);
                }
            }
        } else if self.first != self.next {
            let reversal = self.queue.get(self.first as usize & (REVERSALS - 1)).copied().unwrap_or(0);
            self.first = self.first.wrapping_add(1);
            if let Some(place) = self.residue.get_mut(self.length as usize) {
                *place = reversal;
                self.length = self.length.wrapping_add(1);
            }
            self.four = self.four << 8 | u32::from(reversal);
        }
    }

    /// Takes the cycles that are closed and the times out, and leaves the residue: for the time between two ticks,
    /// before a count of ticks wraps (119 hours at 10 kHz).
    pub fn take(&mut self, config: &TorqueClasses<N>) -> Counts<CLASSES, REVERSALS> {
        let taken = self.snapshot(config);
        (self.cycles, self.ticks, self.largest) = ([0; CLASSES], [0; CLASSES], N::ZERO);
        taken
    }

    fn snapshot(&self, config: &TorqueClasses<N>) -> Counts<CLASSES, REVERSALS> {
        Counts {
            width: config.width,
            period: config.period,
            cycles: self.cycles,
            ticks: self.ticks,
            residue: self.residue,
            length: self.length as usize,
            largest: self.largest.to_real() * config.base,
            lost: self.lost,
        }
    }

    /// The counts so far, with the reversals that wait and the present torque as the last one: for the time between two
    /// ticks.
    pub fn counts(&self, config: &TorqueClasses<N>) -> Counts<CLASSES, REVERSALS> {
        let mut all = *self;
        if all.last >= 0 {
            // the end of the series is its last reversal
            all.put(all.last as u8);
        }
        while all.first != all.next || all.closed().is_some() {
            all.step();
        }
        all.snapshot(config)
    }
}
