//! Complex numbers of a loop's response.

pub(super) type Complex = (f64, f64);

pub(super) const fn times(a: Complex, b: Complex) -> Complex {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}
pub(super) const fn over(a: Complex, b: Complex) -> Complex {
    let square = b.0 * b.0 + b.1 * b.1;
    ((a.0 * b.0 + a.1 * b.1) / square, (a.1 * b.0 - a.0 * b.1) / square)
}
pub(super) const fn plus(a: Complex, b: Complex) -> Complex {
    (a.0 + b.0, a.1 + b.1)
}
pub(super) const fn scaled(factor: f64, a: Complex) -> Complex {
    (factor * a.0, factor * a.1)
}
