//! Rainflow counting on the tick.

use super::class::COUNT;
use super::counts::LONGEST;
use super::{Classed, Counts, TorqueClasses};
use crate::fluctuation::Fluctuation;
use crate::sample::Estimate;

/// Ranges in front of the residue, of which none closes a cycle: each is smaller than the next.
const BEFORE: [i8; 3] = [-2, -1, 0];

/// Rainflow counting of the shaft torque in `CLASSES` classes, from zero torque on.
///
/// A tick without a reversal does one step of the four-point method, and a reversal needs one and a half of them on
/// average. So none is lost where reversals are three ticks apart. Closer ones wait, 255 at most; [`Counts::lost`]
/// counts the ticks at which there was no place. A torque that is NaN is left out.
///
/// ```
/// use driveline::fatigue::{Rainflow, TorqueClasses};
/// use driveline::{fluctuation::Fluctuation, sample::Estimate};
/// // 64 classes of 20 N m; ten swings between -290 and 310 N m: 600 N m, which are 30 classes
/// const CLASSES: TorqueClasses<f32> = TorqueClasses::<f32>::new::<64>(640.0);
/// let mut rainflow = Rainflow::<64, f32>::default();
/// for tick in 0..400 {
///     let shaft_torque = if tick / 20 % 2 == 0 { 310.0 } else { -290.0 };
///     rainflow.measure(&CLASSES, 0, 0.0, &Estimate { shaft_torque, ..Estimate::default() });
/// }
/// // the first and the last half cycle wait in the residue
/// assert_eq!(rainflow.counts(&CLASSES).cycles()[30], 9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
// In this order, the tables last: what stands behind them is beyond the reach of a load.
#[repr(C)]
pub struct Rainflow<const CLASSES: usize, N = f32> {
    /// The largest torque, either way.
    largest: N,
    /// Ticks with a reversal for which there was no place.
    lost: u32,
    /// The present class and the last reversal's: the lowest quarter of a class that does not leave it.
    last: i32,
    reversal: i32,
    /// Place of the residue's third last range, and places of the queue.
    top: u8,
    first: u8,
    next: u8,
    /// Ranges of the residue in classes, which go up and down by turns.
    ranges: [i8; LONGEST],
    /// Ranges that wait, a ring.
    queue: [i8; 256],
    /// Cycles by their range in classes.
    cycles: [u32; CLASSES],
    /// Ticks in each class.
    ticks: [u32; CLASSES],
}

impl<N: Classed, const CLASSES: usize> Default for Rainflow<CLASSES, N> {
    fn default() -> Self {
        let mut ranges = [0; LONGEST];
        ranges[..BEFORE.len()].copy_from_slice(&BEFORE);
        let zero = const {
            assert!(CLASSES.is_power_of_two() && CLASSES >= 4 && CLASSES <= 128, "{}", COUNT);
            2 * CLASSES as i32 - 1
        };
        Rainflow {
            last: zero,
            reversal: zero,
            top: 0,
            first: 0,
            next: 0,
            ranges,
            queue: [0; 256],
            lost: 0,
            cycles: [0; CLASSES],
            ticks: [0; CLASSES],
            largest: N::ZERO,
        }
    }
}

impl<N: Classed, const CLASSES: usize> Fluctuation<N> for Rainflow<CLASSES, N> {
    type Config = TorqueClasses<N>;

    #[inline(always)]
    fn measure(&mut self, config: &TorqueClasses<N>, _angle: u32, _torque: N, estimate: &Estimate<N>) {
        let torque = estimate.shaft_torque;
        if torque.exceeds(self.largest) {
            let largest = torque.magnitude();
            // a NaN alone exceeds itself, and any other torque: it is in no class
            if largest.exceeds(largest) {
                return;
            }
            self.largest = largest;
        }
        let quarters = torque.quarters::<CLASSES>(config.scale);
        let ticks = &mut self.ticks[(quarters >> 2) as usize & (CLASSES - 1)];
        *ticks = ticks.wrapping_add(1);
        if !self.reverses(quarters) {
            self.step();
        }
    }

    /// The torque is an estimate by prediction then, and counts as such.
    #[inline(always)]
    fn disturb(&mut self) {}
}

impl<N: Classed, const CLASSES: usize> Rainflow<CLASSES, N> {
    /// Follows the torque, in quarters of a class; where it turns round its last class is a reversal, and its range
    /// goes into the queue. It leaves a class by a quarter: noise about a boundary between two classes is no reversal.
    #[inline(always)]
    fn reverses(&mut self, quarters: i32) -> bool {
        let last = self.last;
        let moved = quarters.wrapping_sub(last);
        // from a quarter below the last class to a quarter above it
        if (moved as u32) < 6 {
            return false;
        }
        self.last = (quarters & !3).wrapping_sub(1);
        let range = last.wrapping_sub(self.reversal);
        let reverses = (moved ^ range) < 0;
        if reverses {
            self.put(range, last);
        }
        reverses
    }

    /// A range into the queue, up to a reversal. Without a place it is none: the range goes on.
    #[inline(always)]
    fn put(&mut self, range: i32, reversal: i32) {
        let next = self.next.wrapping_add(1);
        if next == self.first {
            self.lost = self.lost.wrapping_add(1);
        } else {
            self.queue[self.next as usize] = (range.unsigned_abs() >> 2) as i8;
            self.next = next;
            self.reversal = reversal;
        }
    }

    /// One step of the four-point method: counts a cycle, or takes a range from the queue. Without its middle range the
    /// outer two and it are one.
    #[inline(always)]
    fn step(&mut self) -> bool {
        let top = self.top as usize;
        let [one, inner, other] = [top, top + 1, top + 2].map(|place| i32::from(self.ranges[place]));
        if inner <= one && inner <= other {
            let cycles = &mut self.cycles[inner as usize & (CLASSES - 1)];
            *cycles = cycles.wrapping_add(1);
            // beyond the classes only where reversals were lost
            self.ranges[top] = one.wrapping_sub(inner).wrapping_add(other).clamp(0, 127) as i8;
            self.top = self.top.wrapping_sub(2);
            true
        } else if self.first != self.next {
            self.ranges[top + 3] = self.queue[self.first as usize];
            self.first = self.first.wrapping_add(1);
            self.top = self.top.wrapping_add(1);
            true
        } else {
            false
        }
    }

    /// Takes the cycles that are closed and the times out, and leaves the residue: for the time between two ticks,
    /// before a count of ticks wraps (119 hours at 10 kHz).
    pub fn take(&mut self, config: &TorqueClasses<N>) -> Counts<CLASSES> {
        let taken = self.snapshot(config);
        (self.cycles, self.ticks, self.largest) = ([0; CLASSES], [0; CLASSES], N::ZERO);
        taken
    }

    /// The counts so far, with the reversals that wait and the present torque as the last one: for the time between two
    /// ticks.
    pub fn counts(&self, config: &TorqueClasses<N>) -> Counts<CLASSES> {
        let mut all = *self;
        while all.step() {}
        // the end of the series is its last reversal
        let range = all.last.wrapping_sub(all.reversal);
        if range != 0 {
            all.put(range, all.last);
            while all.step() {}
        }
        let mut counts = all.snapshot(config);
        // back from the end, down and up by turns, to the start, whose range is none
        let (mut class, mut sign) = (all.last.wrapping_add(1) >> 2, range.signum());
        let known = usize::from(all.top) + BEFORE.len();
        let ranges = all.ranges.iter().take(known).rev().take_while(|&&range| range > 0);
        let mut places = counts.residue.iter_mut().rev();
        for &range in [0].iter().chain(ranges) {
            if range > 0 {
                class = class.wrapping_sub(sign * i32::from(range));
                sign = -sign;
            }
            if let Some(place) = places.next() {
                *place = class as u8;
                counts.length += 1;
            }
        }
        counts
    }

    fn snapshot(&self, config: &TorqueClasses<N>) -> Counts<CLASSES> {
        // where the first torque goes down, the range before it is none, and no cycle
        let mut cycles = self.cycles;
        cycles[0] = 0;
        Counts {
            width: config.width,
            period: config.period,
            cycles,
            ticks: self.ticks,
            residue: [0; LONGEST],
            length: 0,
            largest: self.largest.to_real() * config.base,
            lost: self.lost,
        }
    }
}
