//! Small dense matrices whose shape is part of the type.

/// A matrix of `R` rows and `C` columns, row by row.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Matrix<const R: usize, const C: usize>(pub [[f64; C]; R]);

impl<const R: usize, const C: usize> Matrix<R, C> {
    /// All zeros.
    pub const ZERO: Self = Self([[0.0; C]; R]);

    /// The product `self * right`.
    #[must_use]
    pub const fn times<const K: usize>(&self, right: &Matrix<C, K>) -> Matrix<R, K> {
        let mut product = Matrix::ZERO;
        each!(i, 0..R, {
            let row = &self.0[i];
            each!(k, 0..K, {
                let mut sum = 0.0;
                each!(j, 0..C, {
                    sum += row[j] * right.0[j][k];
                });
                product.0[i][k] = sum;
            });
        });
        product
    }

    /// The sum `self + factor * right`.
    #[must_use]
    pub const fn plus(&self, factor: f64, right: &Self) -> Self {
        let mut sum = *self;
        each!(i, 0..R, {
            each!(j, 0..C, {
                sum.0[i][j] += factor * right.0[i][j];
            });
        });
        sum
    }

    /// A column times its transpose and a factor.
    #[inline(always)]
    pub(super) const fn square_of(column: &[f64; R], factor: f64) -> Matrix<R, R> {
        let mut square = Matrix::ZERO;
        each!(i, 0..R, {
            each!(j, 0..R, {
                square.0[i][j] = column[i] * column[j] * factor;
            });
        });
        square
    }

    /// Rows and columns exchanged.
    #[must_use]
    pub const fn transpose(&self) -> Matrix<C, R> {
        let mut other = Matrix::ZERO;
        each!(i, 0..R, {
            each!(j, 0..C, {
                other.0[j][i] = self.0[i][j];
            });
        });
        other
    }

    /// Every row times its factor of `rows`, every column over its factor of `columns`: a change of units.
    #[must_use]
    pub const fn scaled(&self, rows: &[f64; R], columns: &[f64; C]) -> Self {
        let mut other = *self;
        each!(i, 0..R, {
            each!(j, 0..C, {
                other.0[i][j] = other.0[i][j] * rows[i] / columns[j];
            });
        });
        other
    }

    /// The largest sum of sizes down a column.
    #[must_use]
    pub const fn norm(&self) -> f64 {
        let mut largest = 0.0;
        each!(j, 0..C, {
            let mut sum = 0.0;
            each!(i, 0..R, {
                sum += self.0[i][j].abs();
            });
            if sum > largest || sum.is_nan() {
                largest = sum;
            }
        });
        largest
    }
}

impl<const N: usize> Matrix<N, N> {
    /// The unit matrix.
    pub const IDENTITY: Self = Self::diagonal(&[1.0; N]);

    /// A diagonal matrix.
    #[must_use]
    pub const fn diagonal(values: &[f64; N]) -> Self {
        let mut matrix = Self::ZERO;
        each!(i, 0..N, {
            matrix.0[i][i] = values[i];
        });
        matrix
    }

    /// The mean of the matrix and its transpose.
    #[must_use]
    pub const fn symmetric(&self) -> Self {
        let mut other = *self;
        each!(i, 0..N, {
            each!(j, 0..N, {
                other.0[i][j] = 0.5 * (self.0[i][j] + self.0[j][i]);
            });
        });
        other
    }

    /// `X` in `self * X = right`, by LU with row exchanges; `None` where the matrix is singular.
    #[must_use]
    pub const fn solve<const K: usize>(&self, right: &Matrix<N, K>) -> Option<Matrix<N, K>> {
        let mut lu = *self;
        let mut x = *right;
        each!(pivot, 0..N, {
            let mut best = pivot;
            each!(i, (pivot + 1)..N, {
                if lu.0[i][pivot].abs() > lu.0[best][pivot].abs() {
                    best = i;
                }
            });
            if lu.0[best][pivot] == 0.0 || !lu.0[best][pivot].is_finite() {
                return None;
            }
            lu.0.swap(pivot, best);
            x.0.swap(pivot, best);
            each!(i, (pivot + 1)..N, {
                let factor = lu.0[i][pivot] / lu.0[pivot][pivot];
                if factor != 0.0 {
                    each!(j, (pivot + 1)..N, {
                        lu.0[i][j] -= factor * lu.0[pivot][j];
                    });
                    each!(k, 0..K, {
                        x.0[i][k] -= factor * x.0[pivot][k];
                    });
                }
            });
        });
        let mut row = N;
        while row > 0 {
            row -= 1;
            each!(k, 0..K, {
                let mut sum = x.0[row][k];
                each!(j, (row + 1)..N, {
                    sum -= lu.0[row][j] * x.0[j][k];
                });
                x.0[row][k] = sum / lu.0[row][row];
            });
        }
        Some(x)
    }
}
