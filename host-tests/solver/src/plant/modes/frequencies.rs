//! Natural frequencies from the scaled incidence matrix.

use super::system::{System, SystemError};
use crate::jacobi::{norm, orthogonal};

impl System {
    /// Natural frequencies, rad/s, in rising order, zero for every rigid motion. Each keeps its digits (2e-15 was seen)
    /// whatever the ratios between inertias and between stiffnesses, for the stiffness matrix is never formed.
    ///
    /// # Errors
    /// [`SystemError`] names the first thing that is out of range.
    pub fn frequencies(&self) -> Result<Vec<f64>, SystemError> {
        let reduced = self.reduce()?;
        let coordinates = reduced.inertia.len();
        let rigid = reduced.rigid_motions();
        // the columns of the transpose, one per link
        let mut values = singular_values(reduced.scaled_incidence());
        values.truncate(coordinates - rigid);
        values.resize(coordinates, 0.0);
        values.reverse();
        Ok(values)
    }
}

/// Singular values of the matrix with these columns, in falling order.
fn singular_values(columns: Vec<Vec<f64>>) -> Vec<f64> {
    let rows = columns.first().map_or(0, Vec::len);
    orthogonal(columns, rows).iter().map(|column| norm(column)).collect()
}
