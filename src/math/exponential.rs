//! Exponential and natural logarithm.

use super::{nearest, scale_by_power_of_two};

/// ln 2 with 33 bits, so that products with a power of two's exponent are exact, and the rest of it.
const LN_2: [f64; 2] = [f64::from_bits(0x3FE6_2E42_FEE0_0000), f64::from_bits(0x3DEA_39EF_3579_3C76)];

/// `x = k ln 2 + r` with `|r| <= ln 2 / 2`: the pair `(k, e^r - 1)`.
const fn reduced(x: f64) -> (i32, f64) {
    let k = nearest(x * core::f64::consts::LOG2_E);
    let high = x - k * LN_2[0];
    let low = k * LN_2[1];
    let r = high - low;
    let lost = (high - r) - low;
    // Taylor's series: the first term left out is below 1e-19.
    let mut sum = 0.0;
    let mut n = 16;
    while n >= 3 {
        sum = (1.0 + sum) * r / n as f64;
        n -= 1;
    }
    (k as i32, r + (0.5 * (r * r) * (1.0 + sum) + lost * (1.0 + r)))
}

/// `e^x`, within 1 ulp; zero below -745.2, infinity above 709.8.
#[must_use]
pub const fn exp(x: f64) -> f64 {
    if x.is_nan() {
        return x;
    }
    if x > 709.79 {
        return f64::INFINITY;
    }
    if x < -745.2 {
        return 0.0;
    }
    let (k, less_one) = reduced(x);
    scale_by_power_of_two(1.0 + less_one, k)
}

/// `e^x - 1`, within 1 ulp, for small arguments too.
#[must_use]
pub const fn exp_m1(x: f64) -> f64 {
    if x.is_nan() {
        return x;
    }
    if x > 709.79 {
        return f64::INFINITY;
    }
    if x < -40.0 {
        return -1.0;
    }
    let (k, less_one) = reduced(x);
    if k == 0 {
        return less_one;
    }
    if k > 60 {
        return scale_by_power_of_two(1.0 + less_one, k);
    }
    let power = scale_by_power_of_two(1.0, k);
    (power - 1.0) + power * less_one
}

/// Natural logarithm, within 3 ulp; NaN below zero, minus infinity at zero.
#[must_use]
pub const fn ln(x: f64) -> f64 {
    if x.is_nan() || x < 0.0 {
        return f64::NAN;
    }
    if x == 0.0 {
        return f64::NEG_INFINITY;
    }
    if x.is_infinite() {
        return x;
    }
    let (normal, lifted) = if x < f64::MIN_POSITIVE { (x * 18_014_398_509_481_984.0, 54) } else { (x, 0) };
    let bits = normal.to_bits();
    let mut exponent = (bits >> 52) as i32 - 1023 - lifted;
    let mut m = f64::from_bits((bits & ((1 << 52) - 1)) | (1023 << 52));
    if m > core::f64::consts::SQRT_2 {
        m *= 0.5;
        exponent += 1;
    }
    // ln m = 2 artanh s, s = (m - 1)/(m + 1), |s| <= 0.172.
    let f = m - 1.0;
    let s = f / (m + 1.0);
    let z = s * s;
    let mut sum = 0.0;
    let mut n = 11;
    while n >= 1 {
        sum = z * (sum + 1.0 / (2 * n + 1) as f64);
        n -= 1;
    }
    let e = exponent as f64;
    e * LN_2[0] + (2.0 * s + (2.0 * s * sum + e * LN_2[1]))
}
