//! Where in its cycle the motor is, in integers, and when it passed the cycle's end.

/// A cycle as the tick needs it. Made by [`crate::constants`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CycleConfig {
    /// Length of a segment, at most a quarter of a turn [2^-32 turn]; the cycle is a power of two of them.
    pub length: u32,
    /// Number of segments less one, all ones in binary.
    pub last_segment: u32,
    /// What whole segments leave of the cycle [2^-32 turn over `divisor`].
    pub remainder: u32,
    /// Cycles in the whole number of turns that the ratio is given by.
    pub divisor: u32,
    /// The cycle's angle \[rad\].
    pub angle: f64,
    /// Time between two ticks \[s\].
    pub period: f64,
    /// Base of speeds [rad/s]; 1 for floats.
    pub speed: f64,
    /// Base of torques [N m]; 1 for floats.
    pub torque: f64,
}

/// When the motor passed the cycle's end: between the tick before and this one, `beyond/turned` of a tick ago.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Edge {
    /// The first tick beyond it; wraps.
    pub tick: u32,
    /// How far that tick was beyond it [2^-32 turn].
    pub beyond: u32,
    /// How far the motor turned in the tick [2^-32 turn].
    pub turned: u32,
}

impl Edge {
    /// How long before its tick the end was passed, 0 to 1 tick.
    pub fn fraction(&self) -> f64 {
        if self.turned > self.beyond { f64::from(self.beyond) / f64::from(self.turned) } else { 1.0 }
    }

    /// Ticks from an earlier edge to this one.
    pub fn since(&self, earlier: &Edge) -> f64 {
        f64::from(self.tick.wrapping_sub(earlier.tick)) + (earlier.fraction() - self.fraction())
    }
}

/// What a tick has passed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Crossing {
    /// Nothing but the end of a segment.
    Segment,
    /// The end of the cycle, forwards or backwards.
    Cycle { edge: Edge, forward: bool },
    /// More than a segment: the angle was elsewhere, and the turn within the cycle is no longer known.
    Lost,
}

/// The motor's place in its cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Position {
    /// Where the segment begins [2^-32 turn].
    start: u32,
    /// The last angle.
    last: u32,
    /// The segment's number.
    pub segment: u32,
    /// What whole units of 2^-32 turn have left over, in `divisor`s of one.
    carry: u32,
    /// A tick was left out: what is passed next may have been passed in more than one tick.
    unsure: bool,
}

impl Position {
    /// A tick is left out.
    pub fn interrupt(&mut self) {
        self.unsure = true;
    }

    /// Goes to `angle` and calls `crossed` if a segment's end was passed.
    #[inline(always)]
    pub fn advance(&mut self, cycle: &CycleConfig, angle: u32, tick: u32) -> Option<Crossing> {
        let last = core::mem::replace(&mut self.last, angle);
        if angle.wrapping_sub(self.start) < cycle.length { None } else { self.cross(cycle, angle, last, tick) }
    }

    /// How far the motor is into the segment [2^-32 turn].
    #[inline(always)]
    pub fn within(&self, angle: u32) -> u32 {
        angle.wrapping_sub(self.start)
    }

    #[cold]
    fn cross(&mut self, cycle: &CycleConfig, angle: u32, last: u32, tick: u32) -> Option<Crossing> {
        let crossing = self.step(cycle, angle, last, tick)?;
        let unsure = core::mem::replace(&mut self.unsure, false);
        Some(if unsure { Crossing::Lost } else { crossing })
    }

    /// To the segment of `angle`.
    fn step(&mut self, cycle: &CycleConfig, angle: u32, last: u32, tick: u32) -> Option<Crossing> {
        // A segment is at most a quarter of a turn, so twice its length is within a `u32`.
        let into = angle.wrapping_sub(self.start);
        let back = self.start.wrapping_sub(angle);
        if into >= cycle.length && into.wrapping_sub(cycle.length) < cycle.length {
            let end = self.segment == cycle.last_segment;
            let mut start = self.start.wrapping_add(cycle.length);
            let mut carry = self.carry;
            if end {
                carry = carry.wrapping_add(cycle.remainder);
                let whole = carry >= cycle.divisor;
                // `divisor` is never zero; a remainder is less than as many divisors as there are segments.
                if whole {
                    start = start.wrapping_add(carry / cycle.divisor.max(1));
                    carry %= cycle.divisor.max(1);
                }
            }
            let beyond = angle.wrapping_sub(start);
            // Between the last segment's end and the cycle's.
            if (beyond as i32) < 0 {
                return None;
            }
            self.start = start;
            self.carry = carry;
            self.segment = (self.segment + 1) & cycle.last_segment;
            let edge = Edge { tick, beyond, turned: angle.wrapping_sub(last) };
            return Some(if end { Crossing::Cycle { edge, forward: true } } else { Crossing::Segment });
        }
        if back <= cycle.length {
            let beginning = self.segment == 0;
            let beyond = back;
            let turned = last.wrapping_sub(angle);
            if beginning {
                let mut whole = cycle.remainder / cycle.divisor.max(1);
                let part = cycle.remainder % cycle.divisor.max(1);
                if self.carry < part {
                    self.carry = self.carry.wrapping_add(cycle.divisor);
                    whole += 1;
                }
                self.carry = self.carry.wrapping_sub(part);
                self.start = self.start.wrapping_sub(whole);
            }
            self.start = self.start.wrapping_sub(cycle.length);
            self.segment = self.segment.wrapping_sub(1) & cycle.last_segment;
            let edge = Edge { tick, beyond, turned };
            return Some(if beginning { Crossing::Cycle { edge, forward: false } } else { Crossing::Segment });
        }
        let steps = (into as i32).div_euclid((cycle.length as i32).max(1));
        self.start = self.start.wrapping_add((steps as u32).wrapping_mul(cycle.length));
        self.segment = self.segment.wrapping_add(steps as u32) & cycle.last_segment;
        Some(Crossing::Lost)
    }
}
