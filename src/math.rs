//! Elementary functions of an `f64` as `const fn`.
//!
//! Stable Rust offers no square root, sine or exponential in constants. These do, from additions, multiplications,
//! divisions and bit patterns alone, so that the compiler and the running program get the same bits.
//!
//! | function | largest difference seen from the rounded truth (60 digits, some 300 arguments each) |
//! |---|---|
//! | [`sqrt`] | none: correctly rounded, as the processor's |
//! | [`sin_cos`] up to 1e6 rad, [`exp`], [`exp_m1`], [`ln`] | 1 ulp |
//! | [`atan2`] | 2 ulp |

mod circular;
mod exponential;
mod root;
pub(crate) mod single;

pub use circular::{atan2, sin_cos};
pub use exponential::{exp, exp_m1, ln};
pub use root::{hypot, sqrt};

/// `x` times `2^n`, exact unless the result leaves the normal range.
#[must_use]
pub const fn scale_by_power_of_two(x: f64, n: i32) -> f64 {
    let mut y = x;
    let mut left = n;
    while left > 1000 {
        y *= f64::from_bits(2023 << 52);
        left -= 1000;
    }
    // The low end goes in steps that stay normal until the last, so that there is only one rounding.
    while left < -900 {
        y *= f64::from_bits(123 << 52);
        left += 900;
    }
    y * f64::from_bits(((left + 1023) as u64) << 52)
}

/// The nearest whole number, as an `f64`, for `|x|` below 2^51; ties go to the even one.
pub(crate) const fn nearest(x: f64) -> f64 {
    const SHIFT: f64 = 6_755_399_441_055_744.0; // 1.5 * 2^52: its last bit is worth one
    (x + SHIFT) - SHIFT
}
