//! Complex numbers in `f64`, for the solution outside the tick.

use crate::math::sin_cos;

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Complex {
    pub re: f64,
    pub im: f64,
}

impl Complex {
    pub const fn new(re: f64, im: f64) -> Self {
        Self { re, im }
    }

    /// `exp(j angle)`.
    pub const fn direction(angle: f64) -> Self {
        let (im, re) = sin_cos(angle);
        Self { re, im }
    }

    pub const fn plus(self, other: Self) -> Self {
        Self::new(self.re + other.re, self.im + other.im)
    }

    pub const fn minus(self, other: Self) -> Self {
        Self::new(self.re - other.re, self.im - other.im)
    }

    pub const fn times(self, other: Self) -> Self {
        Self::new(self.re * other.re - self.im * other.im, self.re * other.im + self.im * other.re)
    }

    pub const fn scaled(self, by: f64) -> Self {
        Self::new(self.re * by, self.im * by)
    }

    /// The square of the size.
    pub const fn square(self) -> f64 {
        self.re * self.re + self.im * self.im
    }

    /// This over another; zero where that is none.
    pub const fn over(self, other: Self) -> Self {
        let square = other.square();
        if !(square > 0.0) {
            return Self::new(0.0, 0.0);
        }
        self.times(Self::new(other.re, -other.im)).scaled(1.0 / square)
    }
}
