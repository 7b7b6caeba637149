//! A quantity over the angle of a cycle as a Fourier series.

use super::extremes::{Extreme, Fluctuations};
use crate::math::{atan2, hypot, sin_cos};

/// The highest order of a cycle that is looked at.
pub const MAX_ORDER: usize = 16;

/// One order: `cos cos(n theta) + sin sin(n theta)`, with theta the angle of the cycle from 0 to 2 pi.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Order {
    /// Cosine coefficient.
    pub cos: f64,
    /// Sine coefficient.
    pub sin: f64,
}

impl Order {
    /// Half of its peak-to-peak value.
    pub fn amplitude(&self) -> f64 {
        hypot(self.cos, self.sin)
    }

    /// Phase (rad), in (-pi, pi]: the order is `amplitude cos(n theta - phase)`.
    pub fn phase(&self) -> f64 {
        atan2(self.sin, self.cos)
    }

    /// Its derivative by theta, for the `n`th order.
    pub(super) fn derivative(&self, n: f64) -> Order {
        Order { cos: n * self.sin, sin: -n * self.cos }
    }
}

/// Mean over the angle, and the orders from the first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Series {
    /// The mean over the angle.
    pub mean: f64,
    /// Order 1 first.
    pub orders: [Order; MAX_ORDER],
}

impl Series {
    /// The same at every angle.
    pub fn constant(value: f64) -> Series {
        Series { mean: value, ..Series::default() }
    }

    /// Of a table of values at evenly spaced angles over the cycle, the first at theta = 0 and the last one step before
    /// 2 pi; orders below half of the table's length.
    pub fn from_samples(values: &[f64]) -> Series {
        Series::sampled(values.iter().copied(), values.len(), 0.0, values.len().saturating_sub(1) / 2)
    }

    /// Of `count` values at evenly spaced angles, the first `offset` steps from theta = 0.
    pub(super) fn sampled(values: impl Iterator<Item = f64>, count: usize, offset: f64, highest: usize) -> Series {
        let mut series = Series::default();
        let share = 1.0 / count.max(1) as f64;
        for (index, value) in (0_u32..).zip(values) {
            let (sin, cos) = sin_cos(core::f64::consts::TAU * share * (f64::from(index) + offset));
            let (mut c, mut s) = (1.0, 0.0);
            series.mean += share * value;
            for order in series.orders.iter_mut().take(highest) {
                (c, s) = (c * cos - s * sin, s * cos + c * sin);
                order.cos += 2.0 * share * value * c;
                order.sin += 2.0 * share * value * s;
            }
        }
        series
    }

    /// Sum of the squares of its coefficients, but for the mean.
    pub(super) fn square(&self) -> f64 {
        self.orders.iter().map(|order| order.cos * order.cos + order.sin * order.sin).sum()
    }

    /// The highest order that is not zero.
    pub(super) fn highest(&self) -> usize {
        self.orders.iter().rposition(|order| order.cos != 0.0 || order.sin != 0.0).map_or(0, |last| last + 1)
    }

    /// Its extremes as those of a speed whose mean by time is `mean`, over a cycle of `angle` (rad).
    pub(super) fn fluctuations(&self, mean: f64, angle: f64, circle: &Circle) -> Fluctuations {
        let (mut least, mut most) = ((0, f64::INFINITY), (0, f64::NEG_INFINITY));
        for (index, value) in (0_u32..).zip(self.grid(circle)) {
            if value < least.1 {
                least = (index, value);
            }
            if value > most.1 {
                most = (index, value);
            }
        }
        let [max, min] = [most, least].map(|(index, _)| {
            let theta = self.stationary(core::f64::consts::TAU * f64::from(index) / GRID as f64);
            let within = if theta < 0.0 { theta + core::f64::consts::TAU } else { theta };
            Extreme { speed: self.at(theta), angle: within / core::f64::consts::TAU * angle }
        });
        Fluctuations::of(max, min, mean)
    }

    /// The `n`th order, counted from 1; nothing beyond the last.
    pub fn order(&self, n: usize) -> Order {
        n.checked_sub(1).and_then(|index| self.orders.get(index)).copied().unwrap_or_default()
    }

    /// Value at the angle theta of the cycle (rad), 2 pi to the cycle whatever its turns.
    pub fn at(&self, theta: f64) -> f64 {
        let (sin, cos) = sin_cos(theta);
        self.along(cos, sin)
    }

    /// Value where the first order's cosine and sine are these.
    pub(super) fn along(&self, cos: f64, sin: f64) -> f64 {
        let (mut c, mut s) = (1.0, 0.0);
        let mut sum = self.mean;
        for order in &self.orders {
            (c, s) = (c * cos - s * sin, s * cos + c * sin);
            sum += order.cos * c + order.sin * s;
        }
        sum
    }

    /// The derivative by theta.
    pub fn derivative(&self) -> Series {
        let mut derived = Series::default();
        for ((n, order), out) in (1_u32..).zip(&self.orders).zip(&mut derived.orders) {
            *out = order.derivative(f64::from(n));
        }
        derived
    }

    /// Of values at evenly spaced angles from theta = 0, with orders up to `highest`.
    pub(super) fn of(values: &Grid, circle: &Circle, highest: usize) -> Series {
        let mut series = Series { mean: values.iter().sum::<f64>() / GRID as f64, ..Series::default() };
        for (value, &(cos, sin)) in values.iter().zip(circle) {
            let (mut c, mut s) = (1.0, 0.0);
            let part = 2.0 * value / GRID as f64;
            for order in series.orders.iter_mut().take(highest) {
                (c, s) = (c * cos - s * sin, s * cos + c * sin);
                order.cos += part * c;
                order.sin += part * s;
            }
        }
        series
    }

    /// Values at evenly spaced angles from theta = 0.
    pub(super) fn grid(&self, circle: &Circle) -> Grid {
        circle.map(|(cos, sin)| self.along(cos, sin))
    }

    /// Where a stationary value near `theta` is, by Newton's method; `theta` itself where that leads further than an
    /// eighth of a period of the highest order.
    pub(super) fn stationary(&self, theta: f64) -> f64 {
        let (slope, curvature) = (self.derivative(), self.derivative().derivative());
        let mut found = theta;
        for _ in 0..8 {
            let bend = curvature.at(found);
            if bend == 0.0 {
                return theta;
            }
            found -= slope.at(found) / bend;
        }
        if (found - theta).abs() <= core::f64::consts::TAU / GRID as f64 { found } else { theta }
    }
}

/// Points of a grid over the cycle: eight to the highest order's period.
pub(super) const GRID: usize = 8 * MAX_ORDER;

pub(super) type Grid = [f64; GRID];

/// Cosine and sine at evenly spaced angles.
pub(super) type Circle = [(f64, f64); GRID];

pub(super) fn circle() -> Circle {
    let mut points = [(1.0, 0.0); GRID];
    for (index, point) in (0_u32..).zip(&mut points) {
        let (sin, cos) = sin_cos(core::f64::consts::TAU * f64::from(index) / GRID as f64);
        *point = (cos, sin);
    }
    points
}

#[cfg(test)]
mod tests {
    use core::f64::consts::TAU;

    use super::*;

    fn of(n: usize, cos: f64, sin: f64) -> Series {
        let mut series = Series::constant(1.0);
        series.orders[n - 1] = Order { cos, sin };
        series
    }

    #[test]
    fn the_highest_order_has_a_sine_or_a_cosine() {
        assert_eq!(Series::constant(1.0).highest(), 0);
        for n in [1, 3, MAX_ORDER] {
            assert_eq!([of(n, 0.1, 0.0).highest(), of(n, 0.0, -0.1).highest(), of(n, 0.1, 0.1).highest()], [n; 3]);
        }
    }

    /// A little before the cycle's end, at its beginning, and a little behind it.
    #[test]
    fn extremes_are_within_the_cycle() {
        for (phase, expected) in [(-0.001, 2.0 - 0.001 / core::f64::consts::PI), (0.0, 0.0), (TAU / 8.0, 0.25)] {
            let (sin, cos) = f64::sin_cos(phase);
            let found = of(1, cos, sin).fluctuations(1.0, 2.0, &circle());
            // Newton's method ends within rounding of a turn
            assert!((found.max.angle - expected).abs() < 1e-14, "{phase}: {}", found.max.angle);
            assert!((found.max.speed - 2.0).abs() < 1e-14 && found.min.speed.abs() < 1e-14, "{found:?}");
        }
    }

    /// Newton's method finds what is within a step of the grid, and stays where it was otherwise.
    #[test]
    fn a_stationary_value_is_near() {
        let near = TAU / GRID as f64;
        assert!(of(1, 1.0, 0.0).stationary(0.9 * near).abs() < 1e-14);
        for far in [1.5 * near, 0.8, -0.8] {
            assert_eq!(of(1, 1.0, 0.0).stationary(far), far);
        }
    }
}
