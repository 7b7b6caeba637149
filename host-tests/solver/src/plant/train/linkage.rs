//! Mechanisms behind a crank by the Fourier series of their ways: four-bars, toggles, cams, tables.
//!
//! A way `y(phi)` that returns with each turn is sampled at even angles. Its trigonometric interpolation is as exact as
//! the samples where they are dense enough: the coefficients of a smooth way fall off exponentially. From it follow
//!
//! - the inertia of a mass on it, `m y'(phi)^2` `[Wang 1989 (1-15)]`;
//! - the torque of a force along it, `F y'(phi)` `[Wang 1989 (1-12)]`, and so that of a weight against it,
//!   `-m g y'(phi)`.

use std::f64::consts::{PI, TAU};

use super::mesh::Harmonic;

/// Share of the largest coefficient below which one is rounding.
const ROUNDING: f64 = 1e-15;
/// Share of the largest coefficient to which those of the last tenth of the orders fall off.
const RESOLVED: f64 = 1e-10;

/// A Fourier series by an angle: orders with cosine and sine, the mean as order zero.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Orders(pub Vec<Harmonic>);

impl Orders {
    /// From values at even angles of a turn, the first at zero: an odd number of them.
    #[must_use]
    pub fn of(values: &[f64]) -> Self {
        let count = values.len();
        let all = (0..=(count.max(1) - 1) / 2).map(|order| {
            let weight = if order == 0 { 1.0 } else { 2.0 } / count as f64;
            let (mut cosine, mut sine) = (0.0, 0.0);
            for (i, value) in values.iter().enumerate() {
                // whole turns taken off, which keeps the digits of the angle
                let (s, c) = (TAU * ((i * order) % count) as f64 / count as f64).sin_cos();
                (cosine, sine) = (cosine + weight * value * c, sine + weight * value * s);
            }
            Harmonic { order: order as f64, cosine, sine }
        });
        let all: Vec<Harmonic> = all.collect();
        let most = all.iter().map(|h| h.cosine.hypot(h.sine)).fold(0.0, f64::max);
        // what is no number stays
        let is_rounding = |h: &Harmonic| h.cosine.hypot(h.sine) <= ROUNDING * most;
        Self(all.into_iter().filter(|h| !is_rounding(h)).collect())
    }

    /// From a function of the angle (rad) with the period of a turn, sampled at 255 angles or more, until the last
    /// coefficients of its slope are below 1e-10 of the largest. Where 4095 do not suffice it is not a number, which no
    /// train takes.
    #[must_use]
    pub fn sampled(of: impl Fn(f64) -> f64) -> Self {
        let size = |h: &Harmonic| h.order.max(1.0) * h.cosine.hypot(h.sine);
        for count in [255, 511, 1023, 2047, 4095] {
            let values: Vec<f64> = (0..count).map(|i| of(TAU * f64::from(i) / f64::from(count))).collect();
            let series = Self::of(&values);
            let most = series.0.iter().map(size).fold(0.0, f64::max);
            let last = 0.45 * f64::from(count);
            if series.0.iter().all(|h| h.order < last || size(h) <= RESOLVED * most) {
                return series;
            }
        }
        Self(vec![Harmonic { order: 1.0, cosine: f64::NAN, sine: f64::NAN }])
    }

    /// Value at an angle, rad.
    #[must_use]
    pub fn at(&self, angle: f64) -> f64 {
        let one = |h: &Harmonic| h.cosine * (h.order * angle).cos() + h.sine * (h.order * angle).sin();
        self.0.iter().map(one).sum()
    }

    /// Least of 1024 values over a turn, or over the longest period; NaN of a series that is not finite.
    pub(super) fn least(&self) -> f64 {
        let lowest = self.0.iter().map(|h| h.order.abs()).filter(|order| *order > 0.0).fold(1.0, f64::min);
        let values = (0..1024).map(|i| self.at(TAU / lowest * f64::from(i) / 1024.0));
        values.fold(f64::INFINITY, |least, value| if value.is_nan() { value } else { least.min(value) })
    }

    /// Derivative by the angle.
    #[must_use]
    pub fn slope(&self) -> Self {
        let one = |h: &Harmonic| Harmonic { order: h.order, cosine: h.order * h.sine, sine: -h.order * h.cosine };
        Self(self.0.iter().filter(|h| h.order != 0.0).map(one).collect())
    }

    /// A multiple of it: of a slope, the torque of that force along the way.
    #[must_use]
    pub fn times(&self, factor: f64) -> Self {
        let one = |h: &Harmonic| Harmonic { order: h.order, cosine: factor * h.cosine, sine: factor * h.sine };
        Self(self.0.iter().map(one).collect())
    }

    /// Inertia (kg m2) of masses (kg) or inertias on ways (m) or angles (rad) that the angle moves: `sum m y'^2`.
    #[must_use]
    pub fn inertia(ways: &[(f64, &Self)]) -> Self {
        let slopes: Vec<(f64, Self)> = ways.iter().map(|(mass, way)| (*mass, way.slope())).collect();
        Self::sampled(|angle| slopes.iter().map(|(mass, slope)| mass * slope.at(angle).powi(2)).sum())
    }
}

/// A toggle: a four-bar whose rocker drives a link to a slider, on a line through the pivot of the rocker.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Toggle {
    /// Crank, coupler, the rocker to the knee, and the ground, m.
    pub bars: FourBar,
    /// Link from the knee to the slider, m, longer than the rocker.
    pub link: f64,
    /// Direction of the line from the pivot of the rocker to the slider, rad from that of the ground bar.
    pub direction: f64,
}

impl Toggle {
    /// Distance of the slider from the pivot of the rocker (m) at an angle of the crank (rad).
    #[must_use]
    pub fn way(&self, crank: f64) -> f64 {
        let (sine, cosine) = (self.bars.angles(crank)[1] - self.direction).sin_cos();
        let rocker = self.bars.rocker;
        rocker * cosine + (self.link * self.link - (rocker * sine).powi(2)).sqrt()
    }
}

/// A four-bar whose crank turns round: crank, coupler and rocker between two pivots on the ground, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FourBar {
    /// Radius of the crank.
    pub crank: f64,
    /// Coupler from the crank pin to the rocker.
    pub coupler: f64,
    pub rocker: f64,
    /// From the pivot of the crank to that of the rocker.
    pub ground: f64,
}

impl FourBar {
    /// Whether the crank turns round and the rocker swings: the crank is the shortest bar, and with the longest one
    /// shorter than the two others together (Grashof).
    #[must_use]
    pub fn is_crank_rocker(&self) -> bool {
        let others = [self.coupler, self.rocker, self.ground];
        let longest = others.iter().copied().fold(0.0, f64::max);
        let sum: f64 = others.iter().sum();
        self.crank > 0.0 && others.iter().all(|bar| self.crank < *bar) && self.crank + longest < sum - longest
    }

    /// Angles (rad) of coupler and rocker to the line from the crank's pivot to the rocker's, at an angle of the crank
    /// (rad) to it. The rocker is on the positive side.
    #[must_use]
    pub fn angles(&self, crank: f64) -> [f64; 2] {
        let (x, y) = (self.crank * crank.cos(), self.crank * crank.sin());
        let (dx, dy) = (self.ground - x, -y);
        let across = dx.hypot(dy);
        // the triangle of coupler, rocker and the line from the pin to the rocker's pivot
        let at_pin =
            (self.coupler * self.coupler + across * across - self.rocker * self.rocker) / (2.0 * self.coupler * across);
        let coupler = dy.atan2(dx) + at_pin.clamp(-1.0, 1.0).acos();
        let (kx, ky) = (x + self.coupler * coupler.cos() - self.ground, y + self.coupler * coupler.sin());
        [coupler, ky.atan2(kx)]
    }

    /// Rates of coupler and rocker per rate of the crank, at an angle of the crank (rad) to the line of the pivots:
    /// `a sin(phi - psi)/(b sin(psi - theta))` and `a sin(phi - theta)/(c sin(psi - theta))`, the derivatives of the
    /// closed loop.
    #[must_use]
    pub fn rates(&self, crank: f64) -> [f64; 2] {
        let [coupler, rocker] = self.angles(crank);
        let over = self.crank / (rocker - coupler).sin();
        [over * (crank - rocker).sin() / self.coupler, over * (crank - coupler).sin() / self.rocker]
    }

    /// Angles of the crank, rad, at which the rocker reverses: with the coupler stretched out, and folded back.
    #[must_use]
    pub fn dead_centres(&self) -> [f64; 2] {
        // from the crank's pivot to the pin of coupler and rocker, in the triangle with rocker and ground
        let towards = |reach: f64| {
            let across = reach * reach + self.ground * self.ground - self.rocker * self.rocker;
            (across / (2.0 * reach * self.ground)).clamp(-1.0, 1.0).acos()
        };
        [towards(self.coupler + self.crank), towards(self.coupler - self.crank) + PI]
    }
}
