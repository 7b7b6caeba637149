//! The matrix exponential.

use nalgebra::DMatrix;

/// `exp(M)` by scaling, Taylor's series and squaring of `exp - 1`, which keeps the digits of a small step.
pub fn exponential(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let norm = matrix.row_iter().map(|row| row.iter().map(|v| v.abs()).sum::<f64>()).fold(0.0, f64::max);
    let squarings = if norm > 0.5 { (norm / 0.5).log2().ceil() as i32 } else { 0 };
    let small = matrix * 0.5_f64.powi(squarings);
    let unity = DMatrix::identity(matrix.nrows(), matrix.ncols());
    // Horner's scheme; what is left out is below 0.5^15/15! = 2e-17
    let mut sum = DMatrix::zeros(matrix.nrows(), matrix.ncols());
    for order in (1..=14).rev() {
        sum = (&small * (&sum + &unity)) / f64::from(order);
    }
    for _ in 0..squarings {
        sum = &sum * 2.0 + &sum * &sum;
    }
    sum + unity
}

#[cfg(test)]
mod tests {
    use crate::exponential::*;

    #[test]
    fn a_rotation_is_sine_and_cosine() {
        let e = exponential(&DMatrix::from_row_slice(2, 2, &[0.0, 20.0, -20.0, 0.0]));
        // six squarings of a few units in the last place each
        assert!((e[(0, 0)] - 20.0_f64.cos()).abs() < 2e-14);
        assert!((e[(0, 1)] - 20.0_f64.sin()).abs() < 2e-14);
    }
}
