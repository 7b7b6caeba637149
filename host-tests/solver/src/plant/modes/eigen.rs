//! Eigenvalues and shapes of ordinary systems, with and without damping.

use nalgebra::{Complex, DMatrix, SymmetricEigen};

use super::system::{Reduced, System, SystemError};

/// Natural frequencies and shapes.
#[derive(Debug, Clone, PartialEq)]
pub struct Modes {
    /// rad/s, rising; exactly zero for a rigid motion.
    pub omega: Vec<f64>,
    /// Of each mode, the angle of every node (rad), scaled to `sum J phi^2 = 1` (rad2 kg m2).
    pub shapes: Vec<Vec<f64>>,
    /// The nodes that no gear ties to another, one per mode.
    pub free_nodes: Vec<usize>,
}

impl System {
    /// Undamped modes from the eigenvalues of the mass-normalised stiffness. Relative error about 1e-16 times the ratio
    /// of the largest to the smallest non-zero eigenvalue; beyond 1e6 take [`frequencies`](Self::frequencies).
    ///
    /// # Errors
    /// [`SystemError`] names the first thing that is out of range.
    pub fn modes(&self) -> Result<Modes, SystemError> {
        let reduced = self.reduce()?;
        let incidence = incidence(&reduced);
        let eigen = SymmetricEigen::new(incidence.transpose() * &incidence);
        let n = reduced.inertia.len();
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
        let rigid = reduced.rigid_motions();
        let omega = order.iter().enumerate().map(
            |(rank, &i)| {
                if rank < rigid { 0.0 } else { eigen.eigenvalues[i].max(0.0).sqrt() }
            },
        );
        let shapes = order.iter().map(|&i| {
            let angle = |&(c, ratio): &(usize, f64)| ratio * eigen.eigenvectors[(c, i)] / reduced.inertia[c].sqrt();
            reduced.ties.iter().map(angle).collect()
        });
        Ok(Modes { omega: omega.collect(), shapes: shapes.collect(), free_nodes: reduced.free.clone() })
    }

    /// Eigenvalues of the damped system, 1/s, two for every free coordinate, from the pair of equations for scaled link
    /// torques and scaled speeds, whose matrix is of the size of the frequencies and not of their squares. Sorted by
    /// size, then by imaginary part. The angle of a rigid motion brings an exact zero.
    ///
    /// # Errors
    /// [`SystemError`] names the first thing that is out of range.
    pub fn damped_eigenvalues(&self) -> Result<Vec<(f64, f64)>, SystemError> {
        let reduced = self.reduce()?;
        let s = incidence(&reduced);
        let (r, n) = s.shape();
        let mut matrix = DMatrix::zeros(r + n, r + n);
        for row in 0..r {
            for column in 0..n {
                matrix[(row, r + column)] = s[(row, column)];
                matrix[(r + column, row)] = -s[(row, column)];
            }
        }
        for a in 0..n {
            matrix[(r + a, r + a)] -= reduced.disc_damping[a] / reduced.inertia[a];
            for b in 0..n {
                let scale = (reduced.inertia[a] * reduced.inertia[b]).sqrt();
                for link in &reduced.links {
                    let row = link.row(n);
                    matrix[(r + a, r + b)] -= link.damping * row[a] * row[b] / scale;
                }
            }
        }
        let mut values: Vec<Complex<f64>> = matrix.complex_eigenvalues().iter().copied().collect();
        // links beyond one per coordinate bring zeros of their own; rigid angles lack theirs
        values.sort_by(|a, b| b.norm().total_cmp(&a.norm()));
        values.truncate(2 * n);
        values.resize(2 * n, Complex::new(0.0, 0.0));
        let mut pairs: Vec<(f64, f64)> = values.iter().map(|v| (v.re, v.im)).collect();
        pairs.sort_by(|a, b| a.0.hypot(a.1).total_cmp(&b.0.hypot(b.1)).then(b.1.total_cmp(&a.1)));
        Ok(pairs)
    }
}

fn incidence(reduced: &Reduced) -> DMatrix<f64> {
    let rows = reduced.scaled_incidence();
    DMatrix::from_fn(rows.len(), reduced.inertia.len(), |r, c| rows[r][c])
}
