//! Growth of free motion, from the coefficients as they are stored.

use super::step::Increments;

/// Natural logarithm of the size of the larger pole of `1 + N`.
///
/// From the trace t and the determinant D of the increments the poles are 1 + m with m^2 - t m + D = 0, and the square
/// of the size of a complex pair is 1 + t + D: what is far below 1 keeps its digits.
pub fn log_radius([[n11, n12], [n21, n22]]: Increments) -> f64 {
    let trace = n11 + n22;
    let determinant = n11 * n22 - n12 * n21;
    let square = 0.25 * trace * trace - determinant;
    if square < 0.0 {
        return 0.5 * (trace + determinant).ln_1p();
    }
    let root = square.sqrt();
    let far = if trace < 0.0 { 0.5 * trace - root } else { 0.5 * trace + root };
    let near = if far == 0.0 { 0.0 } else { determinant / far };
    [near, far].map(log_size).into_iter().fold(f64::NEG_INFINITY, f64::max)
}

/// Logarithm of |1 + m|.
fn log_size(m: f64) -> f64 {
    if m > -1.0 { m.ln_1p() } else { (-2.0 - m).ln_1p() }
}

/// Factor by which free motion grows over so many ticks, less one; zero where it does not.
pub fn growth(increments: Increments, ticks: f64) -> f64 {
    (log_radius(increments) * ticks).exp_m1().max(0.0)
}
