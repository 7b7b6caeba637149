//! Singular values and vectors by one-sided Jacobi rotations, to high relative accuracy.

/// Sweeps over all pairs; ten are usual.
const SWEEPS: usize = 60;

/// Turns columns until they are orthogonal, two by two and the longer one first (de Rijk), by the inner product of
/// their first `rows` entries; the others are carried along. No sum of squares of different columns is ever formed.
/// The longest comes first.
pub fn orthogonal(mut columns: Vec<Vec<f64>>, rows: usize) -> Vec<Vec<f64>> {
    let n = columns.len();
    let mut lengths: Vec<f64> = columns.iter().map(|column| norm(&column[..rows])).collect();
    for _ in 0..SWEEPS {
        let mut turned = false;
        for i in 0..n {
            let longest = (i..n).max_by(|&a, &b| lengths[a].total_cmp(&lengths[b])).unwrap_or(i);
            columns.swap(i, longest);
            lengths.swap(i, longest);
            for j in i + 1..n {
                if orthogonalise(&mut columns, rows, [i, j], [lengths[i], lengths[j]]) {
                    turned = true;
                    for k in [i, j] {
                        lengths[k] = norm(&columns[k][..rows]);
                    }
                }
            }
        }
        if !turned {
            break;
        }
    }
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&a, &b| lengths[b].total_cmp(&lengths[a]));
    order.into_iter().map(|k| std::mem::take(&mut columns[k])).collect()
}

/// Turns two columns of these lengths until they stand upright on each other; false if they do already.
fn orthogonalise(columns: &mut [Vec<f64>], rows: usize, [i, j]: [usize; 2], [a, b]: [f64; 2]) -> bool {
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

/// Length of a column, free of over- and underflow.
pub fn norm(column: &[f64]) -> f64 {
    let largest = column.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    if largest == 0.0 {
        return 0.0;
    }
    largest * column.iter().map(|v| (v / largest).powi(2)).sum::<f64>().sqrt()
}
