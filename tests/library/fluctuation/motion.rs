//! Motions in closed form: the motor's speed over its angle is prescribed.
//!
//! ```text
//! omega(phi, t) = W(t) (1 + sum a_n cos(n theta - p_n)),   W(t) = W0 + ramp t,
//! theta = phi over the cycle's angle, 2 pi to the cycle
//! ```

use core::f64::consts::TAU;

use crate::runge_kutta;

/// One order of the prescribed speed, relative to W.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// Order of the cycle.
    pub n: f64,
    /// Amplitude over the speed.
    pub amplitude: f64,
    /// Phase (rad): the order is `amplitude cos(n theta - phase)`.
    pub phase: f64,
}

/// A prescribed motion.
#[derive(Clone, Debug)]
pub struct Motion {
    /// Speed at the beginning (rad/s); negative backwards.
    pub speed: f64,
    /// Its change (rad/s2).
    pub ramp: f64,
    /// Turns to the cycle.
    pub turns: f64,
    /// The orders.
    pub parts: Vec<Part>,
    /// Angle now (rad).
    pub phi: f64,
    /// Time now (s).
    pub time: f64,
}

impl Motion {
    pub fn new(speed: f64, ramp: f64, turns: f64, parts: &[Part]) -> Self {
        Motion { speed, ramp, turns, parts: parts.to_vec(), phi: 0.3, time: 0.0 }
    }

    /// The ripple over W.
    fn ripple(&self, phi: f64) -> f64 {
        self.parts.iter().map(|part| part.amplitude * (part.n / self.turns * phi - part.phase).cos()).sum()
    }

    fn speed_at(&self, phi: f64, time: f64) -> f64 {
        (self.speed + self.ramp * time) * (1.0 + self.ripple(phi))
    }

    /// Goes on by `dt` (s): Runge and Kutta's fourth order, in steps that turn by less than 2 mrad of the highest
    /// order; its error is below 1e-13 rad a step.
    pub fn advance(&mut self, dt: f64) {
        let highest = self.parts.iter().fold(1.0_f64, |most, part| most.max(part.n / self.turns));
        let steps = (dt * self.speed.abs() * highest / 0.004).ceil().max(1.0);
        let h = dt / steps;
        for _ in 0..steps as u32 {
            let rates = |[phi, time]: [f64; 2]| [self.speed_at(phi, time), 1.0];
            [self.phi, self.time] = runge_kutta::step([self.phi, self.time], h, rates);
        }
    }

    /// Goes on to an angle by Newton's method: the time to it is what is left over the speed.
    pub fn advance_to(&mut self, angle: f64) {
        for _ in 0..6 {
            self.advance((angle - self.phi) / self.motor_speed());
        }
    }

    /// The mean by time over W, of a cycle: the cycle's angle over the integral of dphi/omega, by the rule of
    /// rectangles, which is exact for a series.
    pub fn mean_by_time(&self) -> f64 {
        let points = 20_000;
        let slowness = |k: i32| 1.0 / (1.0 + self.ripple(f64::from(k) / f64::from(points) * TAU * self.turns));
        f64::from(points) / (0..points).map(slowness).sum::<f64>()
    }

    /// Speed of the motor now.
    pub fn motor_speed(&self) -> f64 {
        self.speed_at(self.phi, self.time)
    }

    /// What an encoder of 8192 counts shows, as 2^32 to the turn.
    pub fn encoder(&self) -> u32 {
        ((self.phi / TAU * 8192.0).floor() as i64 as u32) << 19
    }

    /// Largest less least ripple, and the cycle's angles of the extremes over 2 pi, from a fine grid of the closed
    /// form.
    pub fn swing(&self) -> (f64, f64, f64) {
        let points = 100_000;
        let at = |k: i32| self.ripple(f64::from(k) / f64::from(points) * TAU * self.turns);
        let (mut most, mut least) = (0, 0);
        for k in 0..points {
            if at(k) > at(most) {
                most = k;
            }
            if at(k) < at(least) {
                least = k;
            }
        }
        (at(most) - at(least), f64::from(most) / f64::from(points), f64::from(least) / f64::from(points))
    }
}
