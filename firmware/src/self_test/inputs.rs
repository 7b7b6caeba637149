//! A pseudo-random run of inputs, the same bits on host and target.
//!
//! A machine that wanders: its speed walks within +-0.005 turns a tick, its torque and setpoint within +-8 (SI units,
//! or one part in 16 of the fixed-point range). The governor is released after 16 ticks and again after every 1024th.
//! Now and then a sample is bad: the angle jumps or stands still, torque or setpoint are any bits. Only the good angle
//! is continuous; nothing is in closed loop. It is for comparing bits and counting instructions, not for judging
//! control.

use crate::Words;
use crate::scene::Input;

/// Largest speed, angle counts a tick: 2^32 / 200, half a turn in a hundred ticks.
const SPEED_LIMIT: i32 = 21_474_836;

/// The generator of inputs; equal seeds give equal inputs.
#[derive(Clone, Debug)]
pub struct Program {
    random: u32,
    words: Words,
    tick: u32,
    angle: u32,
    seen: u32,
    speed: i32,
}

impl Program {
    /// A program from `seed` (zero counts as one) whose words are of the given number.
    pub const fn new(seed: u32, words: Words) -> Self {
        let random = if seed == 0 { 1 } else { seed };
        Program { random, words, tick: 0, angle: 0, seen: 0, speed: 0 }
    }

    /// Inputs given so far; wraps.
    pub fn ticks(&self) -> u32 {
        self.tick
    }

    /// The next input.
    pub fn next_input(&mut self) -> Input {
        let walk = self.next_signed() >> 13;
        self.speed = self.speed.saturating_add(walk).clamp(-SPEED_LIMIT, SPEED_LIMIT);
        self.angle = self.angle.wrapping_add(self.speed as u32);
        let released = self.tick & 1023 >= 16;
        self.tick = self.tick.wrapping_add(1);
        // Primes, so that every pair of faults meets.
        let jump = if self.tick % 61 < 4 { self.next_signed() as u32 } else { 0 };
        let torque = if self.tick % 67 < 3 { self.next_signed() as u32 } else { self.next_word() };
        let setpoint = if self.tick % 71 < 3 { self.next_signed() as u32 } else { self.next_word() };
        let angle = if self.tick % 73 < 3 { self.seen } else { self.angle.wrapping_add(jump) };
        self.seen = angle;
        Input {
            angle,
            torque,
            setpoint,
            flags: if released { Input::RELEASED } else { 0 },
            vibration: [self.next_word(), self.next_word()],
            asked: [0; 2],
        }
    }

    /// A number in +-8, or in +-2^27 of the fixed-point range, as bits.
    pub fn next_word(&mut self) -> u32 {
        let random = self.next_signed();
        match self.words {
            // 24 bits: exact in an f32, whichever core converts it
            Words::Single => ((random >> 8) as f32 * (8.0 / 8_388_608.0)).to_bits(),
            Words::Fixed => (random >> 4) as u32,
        }
    }

    /// 32 random bits: Marsaglia's xorshift32 (Journal of Statistical Software 8, 14, 2003).
    fn next_signed(&mut self) -> i32 {
        let mut x = self.random;
        x ^= x << 13;
        x ^= x >> 17;
        x ^= x << 5;
        self.random = x;
        x as i32
    }
}
