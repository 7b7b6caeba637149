//! The discrete algebraic Riccati equation, by structure-preserving doubling.
//!
//! [Chu, Fan, Lin, Wang 2004, Int. J. Control 77(8)]: each iteration doubles the horizon of the solution, so some
//! twenty suffice from a millisecond to a quarter of an hour. It converges quadratically and keeps the solution
//! symmetric and positive.

use super::Matrix;

/// A solution of the Riccati equation.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Doubling<const N: usize> {
    /// The stabilising solution.
    pub solution: Matrix<N, N>,
    /// Doublings made.
    pub iterations: u32,
}

/// The stabilising `X` of `X = A^T X (1 + G X)^-1 A + H`, with G and H symmetric and positive semidefinite.
///
/// Where H vanishes the doubling stays at zero, which stabilises only an A that is stable already.
///
/// `None` where it does not converge within 60 doublings: no stabilising solution, or one at the edge of stability.
#[must_use]
pub const fn doubling<const N: usize>(a: &Matrix<N, N>, g: &Matrix<N, N>, h: &Matrix<N, N>) -> Option<Doubling<N>> {
    let (mut a, mut g, mut h) = (*a, *g, *h);
    let mut iterations = 0;
    while iterations < 60 {
        // W = (1 + G H)^-1 applied to A and to G.
        let joint = Matrix::IDENTITY.plus(1.0, &g.times(&h));
        let Some(wa) = joint.solve(&a) else {
            return None;
        };
        let Some(wg) = joint.solve(&g) else {
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
        let mut i = 0;
        while i < N {
            settled = settled && grown.0[i][i] <= 1e-17 * h.0[i][i];
            i += 1;
        }
        if settled {
            return Some(Doubling { solution: h, iterations });
        }
    }
    None
}
