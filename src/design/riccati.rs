//! The discrete algebraic Riccati equation, by structure-preserving doubling.

mod five;

use super::Matrix;
use five::{Solver, Square};

/// The stabilising `X` of `X = A^T X (1 + G X)^-1 A + H`, with G and H symmetric and positive semidefinite.
///
/// Where H vanishes the doubling stays at zero, which stabilises only an A that is stable already.
///
/// `None` where it does not converge within 60 doublings: no stabilising solution, or one at the edge of stability.
///
/// [Chu, Fan, Lin, Wang 2004, Int. J. Control 77(8)]: each iteration doubles the horizon of the solution, so some
/// twenty suffice from a millisecond to a quarter of an hour. It converges quadratically and keeps the solution
/// symmetric and positive.
///
/// The states may have units of very different sizes. Rows are chosen in units of the standard deviations found so far;
/// as powers of two they round nothing.
#[must_use]
pub const fn doubling<const N: usize>(a: &Matrix<N, N>, g: &Matrix<N, N>, h: &Matrix<N, N>) -> Option<Matrix<N, N>> {
    if let (Some(a), Some(g), Some(h)) = (five::square(a), five::square(g), five::square(h)) {
        return doubling_of_five(a, g, h);
    }
    let (mut a, mut g, mut h) = (*a, *g, *h);
    let mut iterations = 0;
    while iterations < 60 {
        // W = (1 + G H)^-1 applied to A and to G.
        let units = units(&h);
        let joint = Matrix::IDENTITY.plus(1.0, &g.times(&h)).scaled(&units, &[1.0; N]);
        let Some(wa) = joint.solve(&a.scaled(&units, &[1.0; N])) else {
            return None;
        };
        let Some(wg) = joint.solve(&g.scaled(&units, &[1.0; N])) else {
            return None;
        };
        let back = a.transpose();
        // (1 + H G)^-1 is the transpose of W, and W^T H = H W.
        let grown = back.times(&h.times(&wa)).symmetric();
        g = g.plus(1.0, &a.times(&wg).times(&back)).symmetric();
        h = h.plus(1.0, &grown);
        a = a.times(&wa);
        iterations += 1;
        if !h.norm().is_finite() {
            return None;
        }
        // Judged against the diagonal, for which every state counts by its own size.
        let mut settled = true;
        each!(i, 0..N, {
            settled = settled && grown.0[i][i] <= 1e-17 * h.0[i][i];
        });
        if settled {
            return Some(h);
        }
    }
    None
}

/// The powers of two just below the standard deviations of a covariance; 1 where it has none.
const fn units<const N: usize>(covariance: &Matrix<N, N>) -> [f64; N] {
    let mut units = [1.0; N];
    each!(i, 0..N, {
        let variance = covariance.0[i][i];
        if variance > 0.0 {
            // half the exponent, rounded down
            let exponent = (variance.to_bits() as i64 >> 52) - 1023;
            units[i] = f64::from_bits((((exponent >> 1) + 1023) << 52) as u64);
        }
    });
    units
}

/// The same for five states.
const fn doubling_of_five<const N: usize>(mut a: Square, mut g: Square, mut h: Square) -> Option<Matrix<N, N>> {
    let mut iterations = 0;
    while iterations < 60 {
        let joint = five::sum(&five::UNIT, &five::product(&g, &h));
        let Some(solver) = Solver::new(&joint, units(&Matrix(h))) else {
            return None;
        };
        let back = five::transpose(&a);
        let wa = five::transpose(&solver.columns(&back));
        let grown = five::symmetric(&five::product(&back, &five::product(&h, &wa)));
        let wg = five::transpose(&solver.columns(&five::transpose(&g)));
        g = five::symmetric(&five::sum(&g, &five::product(&five::product(&a, &wg), &back)));
        h = five::sum(&h, &grown);
        a = five::product(&a, &wa);
        iterations += 1;
        if !five::is_finite(&h) {
            return None;
        }
        let [a0, b0, c0, d0, e0] = five::diagonal(&grown);
        let [a1, b1, c1, d1, e1] = five::diagonal(&h);
        if a0 <= 1e-17 * a1 && b0 <= 1e-17 * b1 && c0 <= 1e-17 * c1 && d0 <= 1e-17 * d1 && e0 <= 1e-17 * e1 {
            return Some(five::matrix(&h));
        }
    }
    None
}
