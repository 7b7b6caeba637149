//! The float that readings are calculated in between the ticks.

use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use crate::math;

/// `f32` or `f64`: the same readings on the controller and as the host's yardstick.
pub trait Real:
    Copy
    + Default
    + PartialEq
    + PartialOrd
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + Into<f64>
{
    /// Zero.
    const ZERO: Self;
    /// One.
    const ONE: Self;
    /// Infinity.
    const INFINITY: Self;

    /// The number nearest to a constant.
    fn of(value: f64) -> Self;
    /// A count.
    fn count(value: u32) -> Self;
    /// A signed whole number.
    fn whole(value: i32) -> Self;
    /// The magnitude.
    fn abs(self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Sine and cosine of an angle (rad).
    fn sin_cos(self) -> (Self, Self);
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// The nearest whole number.
    fn nearest(self) -> Self;
    /// Whether it is neither infinite nor NaN.
    fn is_finite(self) -> bool;

    /// The larger of two; the other one where this is a NaN.
    #[must_use]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }

    /// The smaller of two; the other one where this is a NaN.
    #[must_use]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
}

macro_rules! real {
    ($float:ident, $($functions:ident)::+) => {
        impl Real for $float {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const INFINITY: Self = $float::INFINITY;

            #[inline(always)]
            fn of(value: f64) -> Self {
                value as $float
            }

            #[inline(always)]
            fn count(value: u32) -> Self {
                value as $float
            }

            #[inline(always)]
            fn whole(value: i32) -> Self {
                value as $float
            }

            #[inline(always)]
            fn abs(self) -> Self {
                self.abs()
            }

            fn sqrt(self) -> Self {
                $($functions)::+::sqrt(self)
            }

            fn sin_cos(self) -> (Self, Self) {
                $($functions)::+::sin_cos(self)
            }

            fn ln(self) -> Self {
                $($functions)::+::ln(self)
            }

            fn nearest(self) -> Self {
                $($functions)::+::nearest(self)
            }

            #[inline(always)]
            fn is_finite(self) -> bool {
                self.is_finite()
            }
        }
    };
}

real!(f32, math::single);
real!(f64, math);
