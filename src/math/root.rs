//! Square root: Newton steps, then an exact comparison of integers.

use super::scale_by_power_of_two;

/// Square root, correctly rounded for every argument, subnormal ones too; NaN below zero.
#[must_use]
pub const fn sqrt(x: f64) -> f64 {
    if x.is_nan() || x < 0.0 {
        return f64::NAN;
    }
    if x == 0.0 || x.is_infinite() {
        return x;
    }
    // x = m * 2^(2h), with m in [1, 4).
    let (normal, lifted) = if x < f64::MIN_POSITIVE { (x * 18_014_398_509_481_984.0, 54) } else { (x, 0) };
    let bits = normal.to_bits();
    let exponent = (bits >> 52) as i32 - 1023 - lifted;
    let odd = exponent.rem_euclid(2);
    let half = (exponent - odd) / 2;
    let mantissa = (bits & ((1 << 52) - 1)) | (1 << 52);
    let m = f64::from_bits((bits & ((1 << 52) - 1)) | ((1023 + odd as u64) << 52));
    // A straight line meets the root in [1, 4) within 4 %; four Newton steps leave an error of an ulp or so.
    let mut y = 0.375 * m + 0.666;
    let mut step = 0;
    while step < 5 {
        y = 0.5 * (y + m / y);
        step += 1;
    }
    // As integers: n = m 2^104, root = y 2^52. The rounded root r satisfies r^2 - r < n <= r^2 + r.
    let n = (mantissa as u128) << (52 + odd);
    let mut root = (y * 4_503_599_627_370_496.0) as u64 as u128;
    while root * root - root >= n {
        root -= 1;
    }
    while root * root + root < n {
        root += 1;
    }
    scale_by_power_of_two(root as u64 as f64, half - 52)
}

/// Length of the hypotenuse, without overflow on the way; NaN where either side is.
#[must_use]
pub const fn hypot(a: f64, b: f64) -> f64 {
    let (a, b) = (a.abs(), b.abs());
    if a.is_nan() || b.is_nan() {
        return f64::NAN;
    }
    let (large, small) = if a > b { (a, b) } else { (b, a) };
    if large == 0.0 || large.is_infinite() {
        return large;
    }
    let ratio = small / large;
    large * sqrt(1.0 + ratio * ratio)
}
