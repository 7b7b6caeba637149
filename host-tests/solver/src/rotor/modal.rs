//! The rotor in its natural vibrations at rest, undamped: coordinates in which every number is of one size.
//!
//! With `Phi^T M Phi = 1` and `Phi^T K Phi = diag(w^2)` (of the symmetric part of `K`), the state is `(w eta, eta')`.
//! All vibrations together are the model itself; fewer of them, from the lowest, are a reduction.

use nalgebra::{DMatrix, DVector, RowDVector};

use super::error::RotorError;
use super::model::Model;

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

impl Modal {
    /// All vibrations of a model.
    ///
    /// # Errors
    /// [`RotorError::NotHeld`] where some motion meets no stiffness.
    pub fn of(model: &Model) -> Result<Self, RotorError> {
        Self::lowest(model, model.coordinates())
    }

    /// The `count` lowest vibrations of a model.
    ///
    /// # Errors
    /// [`RotorError::NotHeld`] where some motion meets no stiffness.
    pub fn lowest(model: &Model, count: usize) -> Result<Self, RotorError> {
        let lower = model.mass.clone().cholesky().ok_or(RotorError::NotHeld)?.l();
        let symmetric = (&model.stiffness + model.stiffness.transpose()) * 0.5;
        let half = lower.solve_lower_triangular(&symmetric).ok_or(RotorError::NotHeld)?;
        let whole = lower.solve_lower_triangular(&half.transpose()).ok_or(RotorError::NotHeld)?;
        let eigen = ((&whole + whole.transpose()) * 0.5).symmetric_eigen();
        let mut order: Vec<usize> = (0..model.coordinates()).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
        order.truncate(count);
        // Rounding leaves a motion without stiffness with some 1e-16 of the largest eigenvalue.
        let least = 1e-14 * eigen.eigenvalues.max();
        if order.iter().any(|&k| !(eigen.eigenvalues[k] > least)) {
            return Err(RotorError::NotHeld);
        }
        let chosen = eigen.eigenvectors.select_columns(&order);
        let phi = lower.transpose().solve_upper_triangular(&chosen).ok_or(RotorError::NotHeld)?;
        // Rayleigh's quotient: an eigenvalue has roundings of the largest one, its vibration the square of those.
        let strain = (phi.transpose() * &symmetric * &phi).diagonal();
        if !(strain.min() > 0.0) {
            return Err(RotorError::NotHeld);
        }
        let mut order: Vec<usize> = (0..strain.len()).collect();
        order.sort_by(|&a, &b| strain[a].total_cmp(&strain[b]));
        let (phi, strain) = (phi.select_columns(&order), strain.select_rows(&order));
        let project = |matrix: &DMatrix<f64>| phi.transpose() * matrix * &phi;
        Ok(Modal {
            frequency: strain.map(f64::sqrt),
            damping: project(&model.damping),
            gyroscopic: project(&model.gyroscopic),
            circulatory: project(&((&model.stiffness - model.stiffness.transpose()) * 0.5)),
            stations: model.stations.iter().map(|rows| [&rows[0] * &phi, &rows[1] * &phi]).collect(),
            sensors: model.sensors.iter().map(|row| row * &phi).collect(),
        })
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
