//! Discs in the complex plane: arithmetic with centre and radius, the roundings in the radius.

use std::ops::{Add, Mul};

/// Relative error of an operation on centres, with room.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// All complex numbers within a radius of a centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Real and imaginary part of the centre.
    pub centre: (f64, f64),
    /// The radius.
    pub radius: f64,
}

impl Disc {
    /// A disc.
    pub const fn new(centre: (f64, f64), radius: f64) -> Self {
        Self { centre, radius }
    }

    /// The real numbers between two ends, and their roundings.
    pub fn between(low: f64, high: f64) -> Self {
        let centre = 0.5 * (low + high);
        Self::new((centre, 0.0), (0.5 * (high - low) + ROUNDING * centre.abs()) * (1.0 + ROUNDING))
    }

    /// Largest magnitude, up to a rounding.
    pub fn most(&self) -> f64 {
        self.size() + self.radius
    }

    fn size(&self) -> f64 {
        self.centre.0.hypot(self.centre.1)
    }

    /// Whether zero is outside.
    pub fn excludes_zero(&self) -> bool {
        self.size() * (1.0 - ROUNDING) > self.radius
    }

    /// A power.
    pub fn raised(&self, times: u32) -> Self {
        (0..times).fold(Self::new((1.0, 0.0), 0.0), |power, _| power * *self)
    }

    /// The values of a polynomial with real coefficients, the constant first: Taylor's series about the centre.
    pub fn polynomial(&self, coefficients: &[f64]) -> Self {
        let mut shifted: Vec<(f64, f64)> = coefficients.iter().map(|&c| (c, 0.0)).collect();
        let (x, y) = self.centre;
        for start in 0..shifted.len() {
            for k in (start..shifted.len() - 1).rev() {
                let (re, im) = shifted[k + 1];
                shifted[k].0 += re * x - im * y;
                shifted[k].1 += re * y + im * x;
            }
        }
        let most = self.most();
        let horner = |of: &mut dyn Iterator<Item = f64>, by: f64| of.fold(0.0, |sum, c| sum * by + c);
        let rest = horner(&mut shifted[1..].iter().rev().map(|c| c.0.hypot(c.1)), self.radius) * self.radius;
        // a rounding of each of some hundred operations
        let rounded = 100.0
            * f64::EPSILON
            * horner(&mut coefficients.iter().rev().map(|c| c.abs()), most.max(2.0 * self.radius) + 1e-300);
        Self::new(shifted[0], (rest + rounded) * (1.0 + 100.0 * f64::EPSILON))
    }
}

impl Add for Disc {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let centre = (self.centre.0 + other.centre.0, self.centre.1 + other.centre.1);
        let rounded = ROUNDING * (self.most() + other.most());
        Self::new(centre, self.radius + other.radius + rounded)
    }
}

impl Mul for Disc {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let ((a, b), (c, d)) = (self.centre, other.centre);
        let (mine, its) = (self.size(), other.size());
        let radius = mine * other.radius + its * self.radius + self.radius * other.radius + ROUNDING * mine * its;
        Self::new((a * c - b * d, a * d + b * c), radius * (1.0 + 2.0 * ROUNDING))
    }
}

impl Mul<Disc> for f64 {
    type Output = Disc;

    fn mul(self, other: Disc) -> Disc {
        Disc::between(self, self) * other
    }
}
