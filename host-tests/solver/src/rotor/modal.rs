//! The rotor in its natural vibrations at rest, undamped: coordinates in which every number is of one size.
//!
//! With `Phi^T M Phi = 1` and `Phi^T K Phi = diag(w^2)` (of the symmetric part of `K`), the state is `(w eta, eta')`.
//! All vibrations together are the model itself; fewer of them, from the lowest, are a reduction.

use nalgebra::{DMatrix, DVector, RowDVector};

use super::error::RotorError;
use super::model::Model;
use super::pencil::Strain;
use crate::jacobi::{norm, orthogonal};

/// A rotor in modal coordinates.
#[derive(Clone, Debug)]
pub struct Modal {
    /// Natural frequencies at rest, lowest first (rad/s).
    pub(super) frequency: DVector<f64>,
    pub(super) damping: DMatrix<f64>,
    pub(super) gyroscopic: DMatrix<f64>,
    /// Asymmetric part of the stiffness.
    pub(super) circulatory: DMatrix<f64>,
    pub(super) stations: Vec<[RowDVector<f64>; 2]>,
    pub(super) sensors: Vec<RowDVector<f64>>,
}

/// `G` of the symmetric stiffness `G G^T`: a column for each part, so that a soft bearing keeps its digits beside a stiff
/// shaft; where a bearing couples both directions, the factor of Cholesky.
fn springs(model: &Model) -> Option<DMatrix<f64>> {
    let parts: Vec<&Strain> = model.strains.iter().filter(|strain| strain.stiffness != 0.0).collect();
    let n = model.coordinates();
    if parts.len() < n || parts.iter().any(|strain| strain.stiffness < 0.0 || strain.force != strain.motion) {
        let symmetric = (&model.stiffness + model.stiffness.transpose()) * 0.5;
        return Some(symmetric.cholesky()?.l());
    }
    let mut factor = DMatrix::zeros(n, parts.len());
    for (column, strain) in parts.into_iter().enumerate() {
        strain.motion.iter().for_each(|&(at, share)| factor[(at, column)] += strain.stiffness.sqrt() * share);
    }
    Some(factor)
}

impl Modal {
    /// All vibrations of a model.
    ///
    /// # Errors
    /// [`RotorError::NotHeld`] where some motion meets no stiffness.
    pub fn of(model: &Model) -> Result<Self, RotorError> {
        model.held()?;
        let inertia = model.mass.clone().cholesky().ok_or(RotorError::NotHeld)?.l();
        let spring = springs(model).ok_or(RotorError::NotHeld)?;
        // L^-1 G of K = G G^T and M = L L^T: its singular values are the frequencies, its left vectors the shapes
        let scaled = inertia.solve_lower_triangular(&spring).ok_or(RotorError::NotHeld)?;
        let (n, parts) = scaled.shape();
        let carried = |row: usize| (0..n).map(move |at| f64::from(u8::from(at == row)));
        let columns = (0..n).map(|row| scaled.row(row).iter().copied().chain(carried(row)).collect()).collect();
        let mut lowest: Vec<Vec<f64>> = orthogonal(columns, parts);
        lowest.reverse();
        let frequency = DVector::from_iterator(n, lowest.iter().map(|column| norm(&column[..parts])));
        let shapes = DMatrix::from_fn(n, n, |row, k| lowest[k][parts + row]);
        let phi = inertia.tr_solve_lower_triangular(&shapes).ok_or(RotorError::NotHeld)?;
        let project = |matrix: &DMatrix<f64>| phi.transpose() * matrix * &phi;
        Ok(Modal {
            frequency,
            damping: project(&model.damping),
            gyroscopic: project(&model.gyroscopic),
            circulatory: project(&((&model.stiffness - model.stiffness.transpose()) * 0.5)),
            stations: model.stations.iter().map(|rows| [&rows[0] * &phi, &rows[1] * &phi]).collect(),
            sensors: model.sensors.iter().map(|row| row * &phi).collect(),
        })
    }

    /// The `count` lowest of these vibrations.
    #[must_use]
    pub fn lowest(&self, count: usize) -> Self {
        let count = count.min(self.count());
        let square = |matrix: &DMatrix<f64>| matrix.view((0, 0), (count, count)).into_owned();
        let row = |row: &RowDVector<f64>| row.columns(0, count).into_owned();
        Modal {
            frequency: self.frequency.rows(0, count).into_owned(),
            damping: square(&self.damping),
            gyroscopic: square(&self.gyroscopic),
            circulatory: square(&self.circulatory),
            stations: self.stations.iter().map(|[x, y]| [row(x), row(y)]).collect(),
            sensors: self.sensors.iter().map(row).collect(),
        }
    }

    /// Vibrations that are kept.
    #[must_use]
    pub fn count(&self) -> usize {
        self.frequency.len()
    }

    /// Natural frequencies at rest and without damping, lowest first (rad/s).
    #[must_use]
    pub fn frequencies(&self) -> Vec<f64> {
        self.frequency.iter().copied().collect()
    }

    /// `A` of `x' = A x + B f` at a speed (rad/s), `x = (w eta, eta')`.
    pub(super) fn system(&self, speed: f64) -> DMatrix<f64> {
        let r = self.count();
        let mut a = DMatrix::zeros(2 * r, 2 * r);
        for i in 0..r {
            a[(i, r + i)] = self.frequency[i];
            for j in 0..r {
                let restoring = if i == j { self.frequency[i] } else { 0.0 };
                a[(r + i, j)] = -restoring - self.circulatory[(i, j)] / self.frequency[j];
                a[(r + i, r + j)] = -self.damping[(i, j)] - speed * self.gyroscopic[(i, j)];
            }
        }
        a
    }

    /// `B`: two columns a station, its forces along `x` and `y`.
    pub(super) fn input(&self) -> DMatrix<f64> {
        let r = self.count();
        DMatrix::from_fn(2 * r, 2 * self.stations.len(), |row, column| {
            if row < r { 0.0 } else { self.stations[column / 2][column % 2][row - r] }
        })
    }
}
