//! Standard deviation of a delta whose waveform is the derivative of orders by least squares: of the lateness of points
//! over the cycle, each off by noise of its own.
//!
//! Three parts, whose squares add: the noise at both extremes, by how much noise widens them, and the orders next to
//! the highest, as far as they are in what the orders leave.

use core::f64::consts::TAU;

use super::series::{FourierSeries, Order};
use crate::number::Real;

/// Largest less least of a waveform of noise alone, over its deviation: the range of 80 independent normal values is
/// above 5.9 in one of twenty.
const RANGE: f64 = 6.0;

/// Derivative of a delta by the orders of the lateness (cycle), at the angles (2 pi to the cycle) of the largest and
/// the least speed: the slowness is the derivative of the lateness, the speed its inverse.
#[inline(never)]
pub(super) fn sensitivity<R: Real>(
    slowness: &FourierSeries<R>,
    [most, least]: [R; 2],
    highest: usize,
) -> FourierSeries<R> {
    let mut by = FourierSeries::default();
    for (theta, sign) in [(most, R::of(TAU)), (least, R::of(-TAU))] {
        let slow = slowness.at(theta);
        let weight = sign / (slow * slow);
        for (n, order) in (1_u32..).map(R::count).zip(by.orders.iter_mut().take(highest)) {
            let (sin, cos) = (n * theta).sin_cos();
            order.cos += weight * n * sin;
            order.sin -= weight * n * cos;
        }
    }
    by
}

/// Lateness of points over the cycle that the orders leave.
pub(super) struct Left<R> {
    highest: u32,
    points: R,
    sum: R,
    squares: R,
    /// Sums of the two orders next to the highest.
    next: [Order<R>; 2],
}

impl<R: Real> Left<R> {
    pub(super) fn new(highest: usize) -> Self {
        Left { highest: highest as u32, points: R::ZERO, sum: R::ZERO, squares: R::ZERO, next: Default::default() }
    }

    /// Adds a point: its place and what is left of its lateness (cycle).
    #[inline(never)]
    pub(super) fn add(&mut self, place: R, left: R) {
        self.points += R::ONE;
        self.sum += left;
        self.squares += left * left;
        for (n, order) in (self.highest + 1..).zip(&mut self.next) {
            let (sin, cos) = (R::count(n) * R::of(TAU) * place).sin_cos();
            (order.cos, order.sin) = (order.cos + left * cos, order.sin + left * sin);
        }
    }

    fn variation(&self) -> R {
        (self.squares - self.sum * self.sum / self.points.max(R::ONE)).max(R::ZERO)
    }

    /// Root mean square but for the mean (cycle).
    pub(super) fn rms(&self) -> R {
        (self.variation() / self.points.max(R::ONE)).sqrt()
    }

    /// Variance of a point: the orders and the mean are fitted to them (cycle2).
    pub(super) fn variance(&self) -> R {
        self.variation() / (self.points - R::count(1 + 2 * self.highest)).max(R::ONE)
    }

    /// Variance of a coefficient by points of a variance each, were they even.
    pub(super) fn of_coefficient(&self, variance: R) -> R {
        R::of(2.0) * variance / self.points.max(R::ONE)
    }

    /// Square of the slowness's orders next to the highest.
    pub(super) fn beyond(&self) -> R {
        (self.highest + 1..).zip(&self.next).fold(R::ZERO, |squares, (n, order)| {
            let share = R::count(n) * R::of(2.0 * TAU) / self.points.max(R::ONE);
            squares + share * share * order.square()
        })
    }
}

/// Standard deviation of a delta: `own` is its variance by the noise at its extremes, which are at these angles (2 pi
/// to the cycle), `coefficient` that of a coefficient of the lateness (cycle2), `beyond` the square of the slowness's
/// orders next to the highest.
#[inline(never)]
pub(super) fn deviation<R: Real>(
    slowness: &FourierSeries<R>,
    at: [R; 2],
    [own, coefficient, beyond]: [R; 3],
    highest: usize,
) -> R {
    let (mut value, mut slope) = (R::ZERO, R::ZERO);
    for n in (1_u32..).take(highest).map(R::count) {
        let each = coefficient * R::of(TAU * TAU) * n * n;
        value += each;
        slope += each * n * n;
    }
    // An extreme rises by half the square of the slope over the curvature; that of the waveform with its noise is
    // up to twice too large. Without a ripple it is the range of the noise.
    let curved = slowness.derivative().derivative();
    let near = at.iter().fold(R::ZERO, |sum, &theta| sum + slope / curved.at(theta).abs());
    let [most, least] = at.map(|theta| R::ONE / slowness.at(theta));
    let (delta, alone) = ((most - least).abs(), R::of(RANGE) * value.sqrt());
    let widened = near.min(alone).max(delta - (delta * delta - alone * alone).max(R::ZERO).sqrt());
    (own + widened * widened + beyond).sqrt()
}
