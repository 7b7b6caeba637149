//! Standard deviation of a delta whose waveform is the derivative of orders by least squares: of the lateness of points
//! over the cycle, each off by noise of its own.
//!
//! Three parts, whose squares add: the noise at both extremes, by how much noise widens them, and the orders next to
//! the highest, as far as they are in what the orders leave.

use core::f64::consts::TAU;

use super::series::{Order, Series};
use crate::math::{sin_cos, sqrt};

/// Largest less least of a waveform of noise alone, over its deviation: the range of 80 independent normal values is
/// above 5.9 in one of twenty.
const RANGE: f64 = 6.0;

/// Derivative of a delta by the orders of the lateness (cycle), at the angles (2 pi to the cycle) of the largest and
/// the least speed: the slowness is the derivative of the lateness, the speed its inverse.
pub(super) fn sensitivity(slowness: &Series, [most, least]: [f64; 2], highest: usize) -> Series {
    let mut by = Series::default();
    for (theta, sign) in [(most, TAU), (least, -TAU)] {
        let weight = sign / (slowness.at(theta) * slowness.at(theta));
        for (n, order) in (1_u32..).zip(by.orders.iter_mut().take(highest)) {
            let (n, (sin, cos)) = (f64::from(n), sin_cos(f64::from(n) * theta));
            order.cos += weight * n * sin;
            order.sin -= weight * n * cos;
        }
    }
    by
}

/// What the orders leave of the lateness of points over the cycle.
pub(super) struct Left {
    highest: u32,
    points: f64,
    sum: f64,
    squares: f64,
    /// Sums of the two orders next to the highest.
    next: [Order; 2],
}

impl Left {
    pub(super) fn new(highest: usize) -> Self {
        Left { highest: highest as u32, points: 0.0, sum: 0.0, squares: 0.0, next: Default::default() }
    }

    /// Adds a point: its place and what is left of its lateness (cycle).
    pub(super) fn add(&mut self, place: f64, left: f64) {
        self.points += 1.0;
        self.sum += left;
        self.squares += left * left;
        for (n, order) in (self.highest + 1..).zip(&mut self.next) {
            let (sin, cos) = sin_cos(f64::from(n) * TAU * place);
            (order.cos, order.sin) = (order.cos + left * cos, order.sin + left * sin);
        }
    }

    fn variation(&self) -> f64 {
        (self.squares - self.sum * self.sum / self.points.max(1.0)).max(0.0)
    }

    /// Root mean square but for the mean (cycle).
    pub(super) fn rms(&self) -> f64 {
        sqrt(self.variation() / self.points.max(1.0))
    }

    /// Variance of a point: the orders and the mean are fitted to them (cycle2).
    pub(super) fn variance(&self) -> f64 {
        self.variation() / (self.points - f64::from(1 + 2 * self.highest)).max(1.0)
    }

    /// Variance of a coefficient by points of a variance each, were they even.
    pub(super) fn of_coefficient(&self, variance: f64) -> f64 {
        2.0 * variance / self.points.max(1.0)
    }

    /// Square of the slowness's orders next to the highest.
    pub(super) fn beyond(&self) -> f64 {
        (self.highest + 1..).zip(&self.next).fold(0.0, |squares, (n, order)| {
            let amplitude = f64::from(n) * TAU * 2.0 / self.points.max(1.0) * order.amplitude();
            squares + amplitude * amplitude
        })
    }
}

/// Standard deviation of a delta: `own` is its variance by the noise at its extremes, which are at these angles (2 pi
/// to the cycle), `coefficient` that of a coefficient of the lateness (cycle2), `beyond` the square of the slowness's
/// orders next to the highest.
pub(super) fn deviation(slowness: &Series, at: [f64; 2], [own, coefficient, beyond]: [f64; 3], highest: usize) -> f64 {
    let (mut value, mut slope) = (0.0, 0.0);
    for n in (1_u32..).take(highest).map(f64::from) {
        value += coefficient * (TAU * n) * (TAU * n);
        slope += coefficient * (TAU * n * n) * (TAU * n * n);
    }
    // An extreme rises by half the square of the slope over the curvature; that of the waveform with its noise is
    // up to twice too large. Without a ripple it is the range of the noise.
    let curved = slowness.derivative().derivative();
    let near: f64 = at.iter().map(|&theta| slope / curved.at(theta).abs()).sum();
    let delta = at.map(|theta| 1.0 / slowness.at(theta));
    let (delta, alone) = ((delta[0] - delta[1]).abs(), RANGE * sqrt(value));
    let widened = near.min(alone).max(delta - sqrt((delta * delta - alone * alone).max(0.0)));
    sqrt(own + widened * widened + beyond)
}
