//! The exact step of a linear stretch.

use nalgebra::DMatrix;

use crate::exponential::exponential;

/// The exact step over a fixed time of `x' = A x + B (f0 + f1 t)`.
#[derive(Debug, Clone)]
pub(super) struct Propagator {
    /// The step, s.
    pub step: f64,
    /// Of state and torques, and of the rates of these.
    held: DMatrix<f64>,
    rising: DMatrix<f64>,
}

impl Propagator {
    /// `weights` scale the state so that the exponential works on a balanced matrix; `rate` is its norm, 1/s. The state
    /// after the first `moving` moves nothing and gathers from zero.
    pub fn new(a: &DMatrix<f64>, b: &DMatrix<f64>, moving: usize, weights: &[f64], rate: f64, step: f64) -> Self {
        let (m, n) = b.shape();
        let rate = if rate > 0.0 { rate } else { 1.0 };
        let mut whole = DMatrix::zeros(m + 2 * n, m + 2 * n);
        // inputs are scaled by the inertias they act on, so that their columns are of the size of the rate
        let input: Vec<f64> = (0..n)
            .map(|j| (0..m).map(|r| (weights[r] * b[(r, j)]).abs()).fold(0.0, f64::max))
            .map(|size| if size > 0.0 { size / rate } else { 1.0 })
            .collect();
        for r in 0..m {
            for c in 0..m {
                whole[(r, c)] = a[(r, c)] * weights[r] / weights[c] * step;
            }
            for (j, size) in input.iter().enumerate() {
                whole[(r, m + j)] = b[(r, j)] * weights[r] / size * step;
            }
        }
        for j in 0..n {
            whole[(m + j, m + n + j)] = rate * step;
        }
        let e = exponential(&whole);
        let weight = |c: usize| if c < m { weights[c] } else { input[c - m] };
        let kept = (0..moving).chain(m..m + n).collect::<Vec<_>>();
        Self {
            step,
            held: DMatrix::from_fn(m, kept.len(), |r, c| e[(r, kept[c])] * weight(kept[c]) / weights[r]),
            rising: DMatrix::from_fn(m, n, |r, c| e[(r, m + n + c)] * input[c] / weights[r] / rate),
        }
    }

    /// The state after the step, of state and torques; with rates of the torques if they have some.
    pub fn apply(&self, now: &[f64], rise: Option<&[f64]>, out: &mut Vec<f64>) {
        product(&self.held, now, out);
        if let Some(rise) = rise {
            add_product(&self.rising, rise, out);
        }
    }
}

/// `out = M v`.
pub(super) fn product(matrix: &DMatrix<f64>, v: &[f64], out: &mut Vec<f64>) {
    out.clear();
    out.resize(matrix.nrows(), 0.0);
    add_product(matrix, v, out);
}

/// `out += M v` of the first rows and columns, column by column: no sum waits for itself.
pub(super) fn add_product(matrix: &DMatrix<f64>, v: &[f64], out: &mut [f64]) {
    if matrix.nrows() > 0 {
        for (v, column) in v.iter().zip(matrix.as_slice().chunks_exact(matrix.nrows())) {
            out.iter_mut().zip(column).for_each(|(out, c)| *out += c * v);
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::plant::propagator::*;

    #[test]
    fn a_ramp_of_force_on_a_free_mass_is_a_cubic() {
        let mut a = DMatrix::zeros(2, 2);
        a[(0, 1)] = 1.0;
        let mut b = DMatrix::zeros(2, 1);
        b[(1, 0)] = 0.5;
        let step = Propagator::new(&a, &b, 2, &[1.0, 1.0], 0.0, 2.0);
        let mut out = Vec::new();
        step.apply(&[1.0, 3.0, 4.0], Some(&[6.0]), &mut out);
        // x = 1 + 3 t + t^2 + t^3/2 and v = 3 + 2 t + 3 t^2/2 at t = 2, to rounding
        assert!((out[0] - 15.0).abs() < 1e-13 && (out[1] - 13.0).abs() < 1e-13, "{out:?}");
    }
}
