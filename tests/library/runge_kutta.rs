//! Runge and Kutta's fourth order.

use std::array::from_fn;

/// A step of `h` from a state, by the rates of any.
pub fn step<const N: usize>(x: [f64; N], h: f64, rates: impl Fn([f64; N]) -> [f64; N]) -> [f64; N] {
    let plus = |rate: [f64; N], h: f64| from_fn(|k| x[k] + h * rate[k]);
    let a = rates(x);
    let b = rates(plus(a, 0.5 * h));
    let c = rates(plus(b, 0.5 * h));
    let d = rates(plus(c, h));
    plus(from_fn(|k| (a[k] + 2.0 * (b[k] + c[k]) + d[k]) / 6.0), h)
}
