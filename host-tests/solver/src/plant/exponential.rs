//! The matrix exponential, and with it the exact step of a linear stretch.

use super::dense::Dense;

/// `exp(M)` by scaling, Taylor's series and squaring.
///
/// Squares `exp - 1` instead of `exp` (`2 E + E E`), which keeps the digits of a small step. Truncation is far below
/// rounding, which grows with the number of squarings, a few units in the last place each.
pub(super) fn exponential(matrix: &Dense) -> Dense {
    let n = matrix.rows;
    let norm = matrix.row_norm();
    let squarings = if norm > 0.5 { (norm / 0.5).log2().ceil() as i32 } else { 0 };
    let scale = 0.5_f64.powi(squarings);
    let small = matrix.map(|_, _, v| v * scale);
    // Horner's scheme of x + x^2/2! + ... + x^16/16!; what is left out is below 0.5^17/17! = 2e-20
    let mut sum = Dense::zeros(n, n);
    for order in (1..=16).rev() {
        let inverse = 1.0 / f64::from(order);
        let inner = sum.map(|r, c, v| v + f64::from(u8::from(r == c)));
        sum = small.product(&inner).map(|_, _, v| v * inverse);
    }
    for _ in 0..squarings {
        let square = sum.product(&sum);
        sum = sum.map(|r, c, v| 2.0 * v + square.get(r, c));
    }
    sum.map(|r, c, v| v + f64::from(u8::from(r == c)))
}

/// The exact step over a fixed time of `x' = A x + B (f0 + f1 t)`.
#[derive(Debug, Clone)]
pub(super) struct Propagator {
    /// The step, s.
    pub step: f64,
    transition: Dense,
    held: Dense,
    rising: Dense,
}

impl Propagator {
    /// `weights` scale the state so that the exponential works on a balanced matrix; `rate` is its norm, 1/s.
    pub fn new(a: &Dense, b: &Dense, weights: &[f64], rate: f64, step: f64) -> Self {
        let (m, n) = (b.rows, b.cols);
        let rate = if rate > 0.0 { rate } else { 1.0 };
        let mut whole = Dense::zeros(m + 2 * n, m + 2 * n);
        // inputs are scaled by the inertias they act on, so that their columns are of the size of the rate
        let input: Vec<f64> = (0..n)
            .map(|j| (0..m).map(|r| (weights[r] * b.get(r, j)).abs()).fold(0.0, f64::max))
            .map(|size| if size > 0.0 { size / rate } else { 1.0 })
            .collect();
        for r in 0..m {
            for c in 0..m {
                whole.set(r, c, a.get(r, c) * weights[r] / weights[c] * step);
            }
            for (j, size) in input.iter().enumerate() {
                whole.set(r, m + j, b.get(r, j) * weights[r] / size * step);
            }
        }
        for j in 0..n {
            whole.set(m + j, m + n + j, rate * step);
        }
        let e = exponential(&whole);
        let unscale = |block: Dense, per: f64| block.map(|r, j, v| v * input[j] / weights[r] / per);
        Self {
            step,
            transition: e.block(m, 0, m).map(|r, c, v| v * weights[c] / weights[r]),
            held: unscale(e.block(m, m, n), 1.0),
            rising: unscale(e.block(m, m + n, n), rate),
        }
    }

    /// The state after the step.
    pub fn apply(&self, x: &[f64], f0: &[f64], f1: &[f64], ramped: bool, out: &mut [f64]) {
        let rows = out.iter_mut().enumerate();
        for (r, o) in rows {
            let mut sum = super::dense::dot(self.held.row(r), f0);
            if ramped {
                sum += super::dense::dot(self.rising.row(r), f1);
            }
            *o = sum + super::dense::dot(self.transition.row(r), x);
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::plant::exponential::*;

    #[test]
    fn a_rotation_is_sine_and_cosine() {
        let mut m = Dense::zeros(2, 2);
        m.set(0, 1, 20.0);
        m.set(1, 0, -20.0);
        let e = exponential(&m);
        // six squarings of a few units in the last place each
        assert!((e.get(0, 0) - 20.0_f64.cos()).abs() < 2e-14);
        assert!((e.get(0, 1) - 20.0_f64.sin()).abs() < 2e-14);
    }

    #[test]
    fn a_ramp_of_force_on_a_free_mass_is_a_cubic() {
        let mut a = Dense::zeros(2, 2);
        a.set(0, 1, 1.0);
        let mut b = Dense::zeros(2, 1);
        b.set(1, 0, 0.5);
        let step = Propagator::new(&a, &b, &[1.0, 1.0], 0.0, 2.0);
        let mut out = [0.0; 2];
        step.apply(&[1.0, 3.0], &[4.0], &[6.0], true, &mut out);
        // x = 1 + 3 t + t^2 + t^3/2 and v = 3 + 2 t + 3 t^2/2 at t = 2, to rounding
        assert!((out[0] - 15.0).abs() < 1e-13 && (out[1] - 13.0).abs() < 1e-13, "{out:?}");
    }
}
