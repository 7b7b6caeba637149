//! Edges of a wheel at a prescribed speed, and their defects.

use std::f64::consts::TAU;

use driveline::settings::{Teeth, ToothClock};

/// Counts of the clock a second.
pub const CLOCK: f64 = 1e6;

/// One turn to the cycle, down to 19 r/min.
pub const TIMING: ToothClock = ToothClock { turns: 1, clock: CLOCK, lowest_speed: 2.0 };

/// A wheel's speed: its mean (turn/s), and the relative amplitude of a ripple of so many periods to the turn.
#[derive(Clone, Copy)]
pub struct Run {
    pub speed: f64,
    pub ripple: f64,
    pub order: f64,
    /// Standard deviation of an edge's place [mean pitch].
    pub jitter: f64,
    pub seed: u64,
}

/// Random numbers by a linear congruential generator (Knuth, TAOCP 2, 3.3.4, table 1, line 26).
pub struct Random(pub u64);

impl Random {
    /// Even in 0 to 1.
    pub fn even(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Of standard deviation 1: the sum of twelve even ones.
    pub fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.even()).sum::<f64>() - 6.0
    }
}

impl Run {
    /// Time at which the wheel has turned so far (s): t = (x - r/(2 pi n) (cos(2 pi n x) - 1))/v, the integral of a
    /// slowness (1 + r sin(2 pi n x))/v.
    pub fn time(&self, turns: f64) -> f64 {
        let angle = TAU * self.order * turns;
        (turns - self.ripple / (TAU * self.order) * (angle.cos() - 1.0)) / self.speed
    }

    /// Turns after such a time, by bisection.
    pub fn turns(&self, time: f64) -> f64 {
        let (mut low, mut high) = (0.0, 2.0 * self.speed * time + 2.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.time(middle) < time { low = middle } else { high = middle }
        }
        low
    }

    /// Times of the edges over so many turns (s).
    pub fn edges<const TEETH: usize>(&self, teeth: &Teeth<TEETH>, turns: usize) -> Vec<f64> {
        let mut random = Random(self.seed);
        let places = (0..turns).flat_map(|turn| teeth.angles.iter().map(move |angle| turn as f64 + angle));
        places
            .map(|place| self.time(place) + self.jitter / TEETH as f64 / self.speed * random.normal())
            .filter(|time| *time >= 0.0)
            .collect()
    }
}

/// Reading of the clock at a time; it wraps after 3 ms.
pub fn clock(time: f64) -> u32 {
    ((time * CLOCK).round() as i64 as u32).wrapping_sub(3000)
}
