//! A series with the scale of its rounding.

use super::series::{Series, ZERO};

/// Units in the last place that count as rounding: products of a handful of terms, taken a hundredfold.
const ROUNDING: f64 = 1024.0 * f64::EPSILON;

/// A quantity with the same sums taken by magnitude, the scale of its rounding.
#[derive(Debug, Clone)]
pub(super) struct Sized {
    pub value: Series,
    pub size: Series,
}

impl Sized {
    pub fn new(value: f64) -> Self {
        let mut new = Self { value: ZERO, size: ZERO };
        new.put(0, value, value.abs());
        new
    }

    pub fn put(&mut self, k: usize, value: f64, size: f64) {
        (self.value[k], self.size[k]) = (value, size);
    }

    /// `factor` times itself plus a constant, as a guard: values and what rounding may have done to them.
    pub fn guard(&self, factor: f64, constant: f64) -> (Series, Series) {
        let mut values = self.value.map(|v| factor * v);
        let mut rounding = self.size.map(|v| ROUNDING * factor.abs() * v);
        values[0] += constant;
        rounding[0] += ROUNDING * constant.abs();
        (values, rounding)
    }
}
