//! Where in its cycle the motor is, in integers, and when it passed the cycle's end.

use core::f64::consts::TAU;

use crate::number::Number;

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

/// When the motor passed the cycle's end: the time to the tick that found it beyond, from how far and how fast.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Edge<N> {
    /// The first tick beyond it; wraps.
    pub tick: u32,
    /// How far that tick was beyond it [2^-32 turn].
    pub beyond: u32,
    /// The motor's estimated speed.
    pub speed: N,
}

impl<N: Number> Edge<N> {
    /// How long before its tick the end was passed [ticks], where the motor turned by `turned` in a tick \[rad\]; half a tick where that says nothing
    /// of it.
    pub fn fraction(&self, turned: f64) -> f64 {
        let fraction = f64::from(self.beyond) * (TAU / 4_294_967_296.0) / turned;
        // A speed that is a little too low may say a little more than one.
        if fraction < 2.0 { fraction } else { 0.5 }
    }

    /// Ticks from an earlier edge to this one, by the estimated speeds.
    pub fn since(&self, earlier: &Edge<N>, cycle: &CycleConfig) -> f64 {
        let fraction = |edge: &Edge<N>| edge.fraction((edge.speed.to_real() * cycle.speed * cycle.period).abs());
        f64::from(self.tick.wrapping_sub(earlier.tick)) + (fraction(earlier) - fraction(self))
    }
}

/// What a tick has passed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Crossing {
    /// Nothing, or the end of a segment.
    Within,
    /// The end of the cycle, forwards or backwards, and how far the motor is beyond it [2^-32 turn].
    Cycle { beyond: u32, forward: bool },
    /// More than a segment, or nobody knows when: the angle was elsewhere.
    Lost,
}

/// The motor's place in its cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Position {
    /// Where the segment begins [2^-32 turn].
    start: u32,
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

    /// How far the motor is into the segment [2^-32 turn]; from the segment's length on it is in another, and [`Position::pass`] is due.
    #[inline(always)]
    pub fn within(&self, angle: u32) -> u32 {
        angle.wrapping_sub(self.start)
    }

    /// Goes to the segment of `angle`.
    pub fn pass(&mut self, cycle: &CycleConfig, angle: u32) -> Crossing {
        let crossing = self.step(cycle, angle);
        if core::mem::replace(&mut self.unsure, false) { Crossing::Lost } else { crossing }
    }

    fn step(&mut self, cycle: &CycleConfig, angle: u32) -> Crossing {
        // A segment is at most a quarter of a turn, so twice its length is within a `u32`.
        let into = angle.wrapping_sub(self.start);
        let back = self.start.wrapping_sub(angle);
        if into >= cycle.length && into.wrapping_sub(cycle.length) < cycle.length {
            self.forward(cycle, angle)
        } else if back <= cycle.length {
            self.backward(cycle, back)
        } else {
            // The length is never zero.
            let steps = (into as i32).div_euclid((cycle.length as i32).max(1));
            self.start = self.start.wrapping_add((steps as u32).wrapping_mul(cycle.length));
            self.segment = self.segment.wrapping_add(steps as u32) & cycle.last_segment;
            Crossing::Lost
        }
    }

    #[inline(always)]
    fn forward(&mut self, cycle: &CycleConfig, angle: u32) -> Crossing {
        let mut start = self.start.wrapping_add(cycle.length);
        let mut carry = self.carry;
        let end = self.segment == cycle.last_segment;
        if end {
            // The divisor is never zero.
            carry = carry.wrapping_add(cycle.remainder);
            start = start.wrapping_add(carry / cycle.divisor.max(1));
            carry %= cycle.divisor.max(1);
        }
        let beyond = angle.wrapping_sub(start);
        if (beyond as i32) < 0 {
            // Between the last segment's end and the cycle's.
            return Crossing::Within;
        }
        self.start = start;
        self.segment = self.segment.wrapping_add(1) & cycle.last_segment;
        self.carry = carry;
        if end { Crossing::Cycle { beyond, forward: true } } else { Crossing::Within }
    }

    #[inline(always)]
    fn backward(&mut self, cycle: &CycleConfig, beyond: u32) -> Crossing {
        let beginning = self.segment == 0;
        if beginning {
            let divisor = cycle.divisor.max(1);
            let (mut whole, part) = (cycle.remainder / divisor, cycle.remainder % divisor);
            if self.carry < part {
                self.carry = self.carry.wrapping_add(divisor);
                whole = whole.wrapping_add(1);
            }
            self.carry = self.carry.wrapping_sub(part);
            self.start = self.start.wrapping_sub(whole);
        }
        self.start = self.start.wrapping_sub(cycle.length);
        self.segment = self.segment.wrapping_sub(1) & cycle.last_segment;
        if beginning { Crossing::Cycle { beyond, forward: false } } else { Crossing::Within }
    }
}
