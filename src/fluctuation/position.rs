//! Where in its cycle the motor is, in integers, and when it passed the cycle's end.
//!
//! The end of a segment, and even more that of a cycle, takes more than a tick has time for. It is found late and dealt
//! with in slices, one in every other tick, none of which takes longer than a tick's usual work.

use core::f64::consts::TAU;

use crate::number::{Number, Real};

/// A cycle as the tick needs it. Made by [`crate::settings`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CycleConfig {
    /// Length of a segment, at most a quarter of a turn (2^-32 turn); the cycle is a power of two of them.
    pub length: u32,
    /// Number of segments less one, all ones in binary.
    pub last_segment: u32,
    /// Remainder of the cycle after whole segments (2^-32 turn) ...
    pub whole: u32,
    /// ... and its own remainder [2^-32 turn over `divisor`].
    pub part: u32,
    /// Cycles in the whole number of turns that the ratio is given by.
    pub divisor: u32,
    /// The cycle's angle (rad).
    pub angle: f64,
    /// Time between two ticks (s).
    pub period: f64,
    /// Base of speeds (rad/s); 1 for floats.
    pub speed: f64,
    /// Base of torques (N m); 1 for floats.
    pub torque: f64,
}

/// When the motor passed the cycle's end: the time to a tick that found it beyond, from how far and how fast.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Edge<N> {
    /// The tick; wraps.
    pub tick: u32,
    /// Its angle (2^-32 turn).
    pub angle: u32,
    /// How far that was beyond the cycle's end (2^-32 turn).
    pub beyond: u32,
    /// The motor's estimated speed.
    pub speed: N,
}

/// More ticks than an end is found late by.
const LATEST: f64 = 64.0;

impl<N: Number> Edge<N> {
    /// How long before its tick the end was passed (ticks), where the motor turned by `turned` in a tick (rad);
    /// half a tick where that is undefined.
    pub fn fraction(&self, turned: N::Real) -> N::Real {
        let fraction = N::Real::count(self.beyond) * N::Real::of(RADIANS) / turned;
        if fraction < N::Real::of(LATEST) { fraction } else { N::Real::of(0.5) }
    }

    /// Ticks from an earlier edge to this one, by the estimated speeds.
    pub fn since(&self, earlier: &Edge<N>, cycle: &CycleConfig) -> N::Real {
        let tick = N::Real::of(cycle.speed) * N::Real::of(cycle.period);
        let fraction = |edge: &Edge<N>| edge.fraction((edge.speed.real() * tick).abs());
        N::Real::count(self.tick.wrapping_sub(earlier.tick)) + (fraction(earlier) - fraction(self))
    }
}

/// Radians of 2^-32 turn.
pub(super) const RADIANS: f64 = TAU / 4_294_967_296.0;

/// The motor's place in its cycle. Each of its methods is a slice's work.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Position {
    /// Where the segment begins (2^-32 turn).
    pub start: u32,
    /// The segment's number.
    pub segment: u32,
    /// Remainder of whole units of 2^-32 turn at the cycle's beginning, in `divisor`s of one.
    carry: u32,
    /// Excess of the cycle over its segments (2^-32 turn).
    extra: u32,
    /// No tick was left out since the last passage: the next one takes one tick. Not so at first, when the motor may
    /// stand anywhere.
    pub is_sure: bool,
}

/// Passage of a tick that does all slices at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Crossing {
    /// At most the end of one segment or of the cycle.
    Passed,
    /// More, or at an unknown time: the angle was elsewhere.
    Lost,
}

/// Where the motor is that has left its segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Way {
    /// In another segment of the cycle.
    Segment,
    /// In another cycle.
    Cycle,
    /// Not in this direction.
    Other,
}

impl Position {
    /// How far the motor is into the segment (2^-32 turn); from the segment's length on it is in another.
    #[inline(always)]
    pub fn within(&self, angle: u32) -> u32 {
        angle.wrapping_sub(self.start)
    }

    /// Direction of a motor so far beyond the segment's end (2^-32 turn).
    // A segment is at most a quarter of a turn. The motor is looked for in the next two, and in the one before.
    #[inline(always)]
    pub fn ahead(&self, cycle: &CycleConfig, beyond: u32) -> Way {
        if beyond >= cycle.length << 1 {
            Way::Other
        } else if self.segment == cycle.last_segment {
            Way::Cycle
        } else {
            Way::Segment
        }
    }

    /// The same for the motor that is not ahead, and so far behind the segment's start.
    #[inline(always)]
    pub fn behind(&self, cycle: &CycleConfig, behind: u32) -> Way {
        if behind > cycle.length {
            Way::Other
        } else if self.segment == 0 {
            Way::Cycle
        } else {
            Way::Segment
        }
    }

    /// Goes on by a segment, whose number is then to be [counted](Self::count).
    #[inline(always)]
    pub fn advance(&mut self, cycle: &CycleConfig) {
        self.start = self.start.wrapping_add(cycle.length);
    }

    /// Goes back by a segment, whose number is then to be [counted](Self::count).
    #[inline(always)]
    pub fn retreat(&mut self, cycle: &CycleConfig) {
        self.start = self.start.wrapping_sub(cycle.length);
    }

    /// Counts a number of segments further.
    #[inline(always)]
    pub fn count(&mut self, steps: i32) {
        self.segment = self.segment.wrapping_add(steps as u32);
    }

    /// How far the motor that is so far beyond the last segment's end is beyond the cycle's; negative between the two.
    #[inline(always)]
    pub fn beyond_cycle(&self, beyond: u32) -> i32 {
        beyond.wrapping_sub(self.extra) as i32
    }

    /// Goes to the next cycle.
    #[inline(always)]
    pub fn next_cycle(&mut self, cycle: &CycleConfig) {
        self.start = self.start.wrapping_add(cycle.length.wrapping_add(self.extra));
        self.segment = 0;
    }

    /// Remainder of a cycle for the next, now the present one.
    #[inline(always)]
    pub fn carry_on(&mut self, cycle: &CycleConfig) {
        let carry = self.carry.wrapping_add(cycle.part);
        self.carry = if carry >= cycle.divisor { carry.wrapping_sub(cycle.divisor) } else { carry };
    }

    /// Remainder of the cycle before the last, for going back.
    #[inline(always)]
    pub fn carry_back(&mut self, cycle: &CycleConfig) {
        let carry = self.carry.wrapping_sub(cycle.part);
        self.carry = if self.carry < cycle.part { carry.wrapping_add(cycle.divisor) } else { carry };
    }

    /// The length of the cycle, from the remainder of the one before.
    #[inline(always)]
    pub fn measure(&mut self, cycle: &CycleConfig) {
        let up = self.carry.wrapping_add(cycle.part) >= cycle.divisor;
        self.extra = cycle.whole.wrapping_add(up as u32);
    }

    /// Goes to the last segment of the cycle before, whose length is known.
    #[inline(always)]
    pub fn last_cycle(&mut self, cycle: &CycleConfig) {
        self.start = self.start.wrapping_sub(cycle.length.wrapping_add(self.extra));
        self.segment = cycle.last_segment;
    }

    /// How far the motor is behind the end of a cycle that it has come into from there, in its last segment.
    #[inline(always)]
    pub fn behind_end(&self, cycle: &CycleConfig, within: u32) -> u32 {
        cycle.length.wrapping_add(self.extra).wrapping_sub(within)
    }

    /// How many segments the motor is away that is so far from the segment's start.
    #[inline(always)]
    pub fn away(cycle: &CycleConfig, within: u32) -> u32 {
        // The length is never zero.
        (within as i32).div_euclid((cycle.length as i32).max(1)) as u32
    }

    /// Goes a number of segments further.
    #[inline(always)]
    pub fn jump(&mut self, cycle: &CycleConfig, steps: u32) {
        self.start = self.start.wrapping_add(steps.wrapping_mul(cycle.length));
        self.segment = self.segment.wrapping_add(steps) & cycle.last_segment;
    }

    /// Goes to the segment of `angle` at once, for a tick that has the time.
    pub fn pass(&mut self, cycle: &CycleConfig, angle: u32) -> Crossing {
        let is_sure = core::mem::replace(&mut self.is_sure, true);
        let within = self.within(angle);
        let beyond = within.wrapping_sub(cycle.length);
        self.measure(cycle);
        let ahead = if beyond < cycle.length { self.ahead(cycle, beyond) } else { Way::Other };
        match (ahead, self.behind(cycle, within.wrapping_neg())) {
            (Way::Segment, _) => {
                self.advance(cycle);
                self.count(1);
            }
            (Way::Cycle, _) => {
                if self.beyond_cycle(beyond) >= 0 {
                    self.next_cycle(cycle);
                    self.carry_on(cycle);
                }
            }
            (Way::Other, Way::Segment) => {
                self.retreat(cycle);
                self.count(-1);
            }
            (Way::Other, Way::Cycle) => {
                self.carry_back(cycle);
                self.measure(cycle);
                self.last_cycle(cycle);
            }
            (Way::Other, Way::Other) => {
                self.jump(cycle, Position::away(cycle, within));
                return Crossing::Lost;
            }
        }
        if is_sure { Crossing::Passed } else { Crossing::Lost }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CYCLE: CycleConfig = CycleConfig {
        length: 1 << 28,
        last_segment: 3,
        whole: 5,
        part: 2,
        divisor: 3,
        angle: 1.0,
        period: 1.0,
        speed: 1.0,
        torque: 1.0,
    };

    /// Two thirds of 2^-32 turn over at each end of a cycle: in three cycles 2 units, and nothing is left.
    #[test]
    fn the_remainders_of_cycles_add_up_to_whole_units_both_ways() {
        let cycle = CYCLE;
        let mut position = Position::default();
        let mut excess = [0; 6];
        for extra in &mut excess {
            position.measure(&cycle);
            *extra = position.extra;
            position.next_cycle(&cycle);
            position.carry_on(&cycle);
        }
        // 5 + 2/3 each: 5, 11, 17 after one, two, three
        assert_eq!(excess, [5, 6, 6, 5, 6, 6]);
        assert_eq!(position.carry, 0);
        for expected in excess.iter().rev() {
            position.carry_back(&cycle);
            position.measure(&cycle);
            assert_eq!(position.extra, *expected);
        }
        assert_eq!(position.carry, 0);
    }

    /// Units of a sixteenth of a turn: up to the next segment's end, and back to the beginning of the one before. The
    /// cycle ends five units behind its last segment, the one before it six.
    #[test]
    fn a_passage_is_by_a_segment_either_way() {
        const UNIT: u32 = 1 << 28;
        for (segment, within, expected, start) in [
            (1, UNIT, Some(2), UNIT),
            (1, 2 * UNIT - 1, Some(2), UNIT),
            (1, 2 * UNIT, None, 2 * UNIT),
            (1, UNIT.wrapping_neg(), Some(0), UNIT.wrapping_neg()),
            (1, (UNIT + 1).wrapping_neg(), None, (2 * UNIT).wrapping_neg()),
            (3, UNIT + 4, Some(3), 0),
            (3, UNIT + 5, Some(0), UNIT + 5),
            (0, 1_u32.wrapping_neg(), Some(3), (UNIT + 6).wrapping_neg()),
        ] {
            let mut position = Position { segment, is_sure: true, ..Position::default() };
            let crossing = position.pass(&CYCLE, within);
            assert_eq!(crossing, if expected.is_some() { Crossing::Passed } else { Crossing::Lost }, "{within}");
            assert_eq!(position.start, start, "{segment} {within}");
            assert!(expected.is_none_or(|expected| position.segment == expected), "{segment} {within}");
            // at an unknown time
            let mut position = Position { segment, ..Position::default() };
            assert_eq!((position.pass(&CYCLE, within), position.is_sure), (Crossing::Lost, true));
        }
    }

    /// Sixteen units at a quarter of one in a tick are 64 ticks, which an end is not found late by.
    #[test]
    fn an_end_is_half_a_tick_ago_where_it_cannot_be_known() {
        let of = |beyond, turned| Edge { beyond, ..Edge::<f64>::default() }.fraction(turned);
        assert_eq!([of(16, 0.25 * RADIANS), of(8, 0.25 * RADIANS), of(3, 4.0 * RADIANS)], [0.5, 32.0, 0.75]);
        assert_eq!([of(3, 0.0), of(0, 0.0), of(3, f64::NAN)], [0.5; 3]);
    }
}
