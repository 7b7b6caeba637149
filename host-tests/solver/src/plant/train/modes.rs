//! Natural frequencies and shapes of a train with every link in contact at its mean stiffness.

use nalgebra::{DMatrix, SymmetricEigen};

use super::Train;
use crate::plant::error::PlantError;

/// Natural frequencies and shapes.
#[derive(Debug, Clone, PartialEq)]
pub struct TrainModes {
    /// rad/s, rising; near zero for a rigid motion.
    pub omega: Vec<f64>,
    /// Of each mode, the amplitude of every coordinate, scaled to `sum J q^2 = 1`.
    pub shapes: Vec<Vec<f64>>,
}

impl Train {
    /// Undamped modes from the eigenvalues of the mass-normalised stiffness, without what unbalances couple.
    ///
    /// # Errors
    /// [`PlantError`] as [`build`](Self::build).
    pub fn modes(&self) -> Result<TrainModes, PlantError> {
        self.validate()?;
        let n = self.coordinates.len();
        let inertia = self.inertias();
        let mut incidence = DMatrix::zeros(self.links.len(), n);
        for (l, link) in self.links.iter().enumerate() {
            for &(at, share) in &link.terms {
                incidence[(l, at)] = share * (link.mean_stiffness() / inertia[at]).sqrt();
            }
        }
        let eigen = SymmetricEigen::new(incidence.transpose() * &incidence);
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
        let omega = order.iter().map(|&i| eigen.eigenvalues[i].max(0.0).sqrt());
        let shape = |&i: &usize| (0..n).map(|j| eigen.eigenvectors[(j, i)] / inertia[j].sqrt()).collect();
        Ok(TrainModes { omega: omega.collect(), shapes: order.iter().map(shape).collect() })
    }

    /// Inertia of every coordinate, kg m2 or kg, with what a crank adds at its starting angle.
    #[must_use]
    pub fn inertias(&self) -> Vec<f64> {
        self.coordinates.iter().map(|c| c.inertia + c.crank.map_or(0.0, |k| k.inertia(c.angle).0)).collect()
    }
}
