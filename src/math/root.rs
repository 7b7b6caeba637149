//! Square root: Newton steps, then an exact comparison of integers.

/// Square root, correctly rounded for every argument, subnormal ones too; NaN below zero.
#[must_use]
pub const fn sqrt(x: f64) -> f64 {
    if !(x > 0.0 && x < f64::INFINITY) {
        return if x == 0.0 || x == f64::INFINITY { x } else { f64::NAN };
    }
    // x = m * 2^(2h), with m in [1, 4).
    let (normal, lifted) = if x < f64::MIN_POSITIVE { (x * 18_014_398_509_481_984.0, 54) } else { (x, 0) };
    let bits = normal.to_bits() as i64;
    let exponent = (bits >> 52) - 1023 - lifted;
    let (half, odd) = (exponent >> 1, exponent & 1);
    let fraction = bits & ((1 << 52) - 1);
    let m = f64::from_bits((fraction | ((1023 + odd) << 52)) as u64);
    // A straight line meets the root in [1, 4) within 4 %; four Newton steps leave an error of an ulp or so.
    let y = 0.375 * m + 0.666;
    let y = 0.5 * (y + m / y);
    let y = 0.5 * (y + m / y);
    let y = 0.5 * (y + m / y);
    let y = 0.5 * (y + m / y);
    // As integers: n = m 2^104, root = y 2^52, rest = n - root^2. The rounded root has -root < rest <= root.
    let n = ((fraction | (1 << 52)) as i128) << (52 + odd);
    let mut root = (y * 4_503_599_627_370_496.0) as i128;
    let mut rest = n - root * root;
    while rest <= -root {
        root -= 1;
        rest += 2 * root + 1;
    }
    while rest > root {
        rest -= 2 * root + 1;
        root += 1;
    }
    root as f64 * f64::from_bits(((half - 52 + 1023) << 52) as u64)
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
