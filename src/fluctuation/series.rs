//! A quantity over the angle of a cycle as a Fourier series.

use core::f64::consts::TAU;
use core::hint::black_box;

use super::extremes::{Extreme, Fluctuations};
use crate::math::atan2;
use crate::number::Real;

/// The highest order of a cycle that is looked at.
pub const MAX_ORDER: usize = 16;

/// One order: `cos cos(n theta) + sin sin(n theta)`, with theta the angle of the cycle from 0 to 2 pi.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Order<R = f64> {
    /// Cosine coefficient.
    pub cos: R,
    /// Sine coefficient.
    pub sin: R,
}

impl<R: Real> Order<R> {
    /// Half of its peak-to-peak value.
    pub fn amplitude(&self) -> R {
        self.square().sqrt()
    }

    /// Square of the amplitude. A call, so that loops over the orders stay loops.
    #[inline(never)]
    pub(super) fn square(&self) -> R {
        self.cos * self.cos + self.sin * self.sin
    }

    /// Phase (rad), in (-pi, pi]: the order is `amplitude cos(n theta - phase)`.
    pub fn phase(&self) -> R {
        R::of(atan2(self.sin.into(), self.cos.into()))
    }

    /// Turned further by an angle of this sine and cosine: `cos` and `sin` as those of an angle. A call, as above.
    #[inline(never)]
    fn turned(self, (sin, cos): (R, R)) -> Self {
        Order { cos: self.cos * cos - self.sin * sin, sin: self.sin * cos + self.cos * sin }
    }

    /// Its derivative by theta, for the `n`th order.
    pub(super) fn derivative(&self, n: R) -> Self {
        Order { cos: n * self.sin, sin: -n * self.cos }
    }
}

/// Mean over the angle, and the orders from the first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FourierSeries<R = f64> {
    /// The mean over the angle.
    pub mean: R,
    /// Order 1 first.
    pub orders: [Order<R>; MAX_ORDER],
}

impl<R: Real> FourierSeries<R> {
    /// The same at every angle.
    pub fn constant(value: R) -> Self {
        FourierSeries { mean: value, ..FourierSeries::default() }
    }

    /// The series of values at evenly spaced angles over the cycle, the first at theta = 0 and the last one step before
    /// 2 pi; orders below half of the table's length.
    pub fn from_samples(values: &[R]) -> Self {
        FourierSeries::sampled(values.iter().copied(), values.len(), R::ZERO, values.len().saturating_sub(1) / 2)
    }

    /// The series of `count` values at evenly spaced angles, the first `offset` steps from theta = 0.
    pub(super) fn sampled(values: impl Iterator<Item = R>, count: usize, offset: R, highest: usize) -> Self {
        let mut series = FourierSeries::default();
        let share = R::ONE / R::count(count.max(1) as u32);
        for (index, value) in (0_u32..).zip(values) {
            series.add(share * value, (R::of(TAU) * share * (R::count(index) + offset)).sin_cos(), highest);
        }
        series
    }

    /// Adds the share of one of evenly spaced values, at an angle of this sine and cosine.
    fn add(&mut self, part: R, (sin, cos): (R, R), highest: usize) {
        self.mean += part;
        let mut along = Order { cos: part + part, sin: R::ZERO };
        for order in self.orders.iter_mut().take(highest) {
            along = along.turned((sin, cos));
            order.cos += along.cos;
            order.sin += along.sin;
        }
    }

    /// The orders, in a number that the compiler does not know: a loop over them stays one.
    fn kept(&self) -> &[Order<R>] {
        black_box(self.orders.as_slice())
    }

    /// Sum of the squares of its coefficients, but for the mean.
    pub(super) fn square(&self) -> R {
        self.kept().iter().fold(R::ZERO, |sum, order| sum + order.square())
    }

    /// The highest order that is not zero.
    pub(super) fn highest(&self) -> usize {
        self.kept().iter().rposition(|order| order.square() != R::ZERO).map_or(0, |last| last + 1)
    }

    /// Its extremes as those of a speed whose mean by time is `mean`, over a cycle of `angle` (rad).
    pub(super) fn fluctuations(&self, mean: R, angle: R, circle: &Circle<R>) -> Fluctuations<R> {
        self.stationary_values(&self.grid(circle), mean, angle, &|value| value)
    }

    /// The extremes of the grid of a speed whose mean by time is `mean`; it is stationary where the series is, and there
    /// `speed` of it.
    #[inline(never)]
    pub(super) fn stationary_values(
        &self,
        grid: &Grid<R>,
        mean: R,
        angle: R,
        speed: &dyn Fn(R) -> R,
    ) -> Fluctuations<R> {
        let (mut least, mut most) = ((0, R::INFINITY), (0, -R::INFINITY));
        for (index, &value) in (0_u32..).zip(grid) {
            if value < least.1 {
                least = (index, value);
            }
            if value > most.1 {
                most = (index, value);
            }
        }
        let [max, min] = [most, least].map(|(index, _)| {
            let theta = self.stationary(R::of(TAU / GRID as f64) * R::count(index));
            let within = if theta < R::ZERO { theta + R::of(TAU) } else { theta };
            Extreme { speed: speed(self.at(theta)), angle: within * R::of(1.0 / TAU) * angle }
        });
        Fluctuations::of(max, min, mean)
    }

    /// The `n`th order, counted from 1; nothing beyond the last.
    pub fn order(&self, n: usize) -> Order<R> {
        n.checked_sub(1).and_then(|index| self.orders.get(index)).copied().unwrap_or_default()
    }

    /// Value at the angle theta of the cycle (rad), 2 pi to the cycle whatever its turns.
    pub fn at(&self, theta: R) -> R {
        let (sin, cos) = theta.sin_cos();
        self.along(cos, sin)
    }

    /// Value where the first order's cosine and sine are these.
    #[inline(never)]
    pub(super) fn along(&self, cos: R, sin: R) -> R {
        let mut along = Order { cos: R::ONE, sin: R::ZERO };
        let mut sum = self.mean;
        for order in self.kept() {
            along = along.turned((sin, cos));
            sum += order.cos * along.cos + order.sin * along.sin;
        }
        sum
    }

    /// The derivative by theta.
    #[must_use]
    pub fn derivative(&self) -> Self {
        let mut derived = FourierSeries::default();
        for ((n, order), out) in (1_u32..).zip(&self.orders).zip(&mut derived.orders) {
            *out = order.derivative(R::count(n));
        }
        derived
    }

    /// The series of values at evenly spaced angles from theta = 0, with orders up to `highest`.
    #[inline(never)]
    pub(super) fn of(values: &Grid<R>, circle: &Circle<R>, highest: usize) -> Self {
        let mut series = FourierSeries::default();
        for (value, &(cos, sin)) in values.iter().zip(circle) {
            series.add(*value * R::of(1.0 / GRID as f64), (sin, cos), highest);
        }
        series
    }

    /// Values at evenly spaced angles from theta = 0.
    #[inline(never)]
    pub(super) fn grid(&self, circle: &Circle<R>) -> Grid<R> {
        circle.map(|(cos, sin)| self.along(cos, sin))
    }

    /// Where a stationary value near `theta` is, by Newton's method; `theta` itself where that leads further than an
    /// eighth of a period of the highest order.
    #[inline(never)]
    pub(super) fn stationary(&self, theta: R) -> R {
        let slope = self.derivative();
        let curvature = slope.derivative();
        let mut found = theta;
        for _ in 0..8 {
            let bend = curvature.at(found);
            if bend == R::ZERO {
                return theta;
            }
            found -= slope.at(found) / bend;
        }
        if (found - theta).abs() <= R::of(TAU / GRID as f64) { found } else { theta }
    }
}

/// Points of a grid over the cycle: eight to the highest order's period.
pub(super) const GRID: usize = 8 * MAX_ORDER;

pub(super) type Grid<R> = [R; GRID];

/// Cosine and sine at evenly spaced angles.
pub(super) type Circle<R> = [(R, R); GRID];

#[inline(never)]
pub(super) fn circle<R: Real>() -> Circle<R> {
    let mut points = [(R::ONE, R::ZERO); GRID];
    for (index, point) in (0_u32..).zip(&mut points) {
        let (sin, cos) = (R::of(TAU / GRID as f64) * R::count(index)).sin_cos();
        *point = (cos, sin);
    }
    points
}

#[cfg(test)]
mod tests {
    use core::f64::consts::TAU;

    use super::*;

    fn of(n: usize, cos: f64, sin: f64) -> FourierSeries {
        let mut series = FourierSeries::constant(1.0);
        series.orders[n - 1] = Order { cos, sin };
        series
    }

    #[test]
    fn the_highest_order_has_a_sine_or_a_cosine() {
        assert_eq!(FourierSeries::constant(1.0).highest(), 0);
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
