//! Singular values by one-sided Jacobi rotations, to high relative accuracy.

use super::system::{System, SystemError};

/// Sweeps over all pairs; ten are usual.
const SWEEPS: usize = 60;

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

/// Turns columns until they are orthogonal, two by two and the longer one first (de Rijk), by the inner product of
/// their first `rows` entries; the others are carried along. No sum of squares of different columns is ever formed.
/// The longest comes first.
pub(in crate::plant) fn orthogonal(mut columns: Vec<Vec<f64>>, rows: usize) -> Vec<Vec<f64>> {
    let n = columns.len();
    let norm = |column: &[f64]| norm(&column[..rows]);
    for _ in 0..SWEEPS {
        let mut turned = false;
        for i in 0..n {
            let longest = (i..n).max_by(|&a, &b| norm(&columns[a]).total_cmp(&norm(&columns[b])));
            columns.swap(i, longest.unwrap_or(i));
            for j in i + 1..n {
                turned |= orthogonalise(&mut columns, rows, i, j);
            }
        }
        if !turned {
            break;
        }
    }
    columns.sort_by(|a, b| norm(b).total_cmp(&norm(a)));
    columns
}

/// Turns two columns until they stand upright on each other; false if they do already.
fn orthogonalise(columns: &mut [Vec<f64>], rows: usize, i: usize, j: usize) -> bool {
    let (a, b) = (norm(&columns[i][..rows]), norm(&columns[j][..rows]));
    if a == 0.0 || b == 0.0 {
        return false;
    }
    // cosine of the angle between them, free of over- and underflow
    let pairs = columns[i].iter().zip(&columns[j]).take(rows);
    let cosine: f64 = pairs.map(|(x, y)| (x / a) * (y / b)).sum();
    if cosine.abs() <= f64::EPSILON {
        return false;
    }
    let zeta = (b / a - a / b) / (2.0 * cosine);
    let t = if zeta.abs() > 1e150 { 0.5 / zeta } else { zeta.signum() / (zeta.abs() + zeta.hypot(1.0)) };
    let c = 1.0 / t.hypot(1.0);
    let s = c * t;
    for row in 0..columns[i].len() {
        let (x, y) = (columns[i][row], columns[j][row]);
        columns[i][row] = c * x - s * y;
        columns[j][row] = s * x + c * y;
    }
    true
}

pub(in crate::plant) fn norm(column: &[f64]) -> f64 {
    let largest = column.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    if largest == 0.0 {
        return 0.0;
    }
    largest * column.iter().map(|v| (v / largest).powi(2)).sum::<f64>().sqrt()
}
