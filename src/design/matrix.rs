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
        let mut i = 0;
        while i < R {
            let row = &self.0[i];
            let mut k = 0;
            while k < K {
                let mut sum = 0.0;
                let mut j = 0;
                while j < C {
                    sum += row[j] * right.0[j][k];
                    j += 1;
                }
                product.0[i][k] = sum;
                k += 1;
            }
            i += 1;
        }
        product
    }

    /// The sum `self + factor * right`.
    #[must_use]
    pub const fn plus(&self, factor: f64, right: &Self) -> Self {
        let mut sum = *self;
        let mut i = 0;
        while i < R {
            let mut j = 0;
            while j < C {
                sum.0[i][j] += factor * right.0[i][j];
                j += 1;
            }
            i += 1;
        }
        sum
    }

    /// Rows and columns exchanged.
    #[must_use]
    pub const fn transpose(&self) -> Matrix<C, R> {
        let mut other = Matrix::ZERO;
        let mut i = 0;
        while i < R {
            let mut j = 0;
            while j < C {
                other.0[j][i] = self.0[i][j];
                j += 1;
            }
            i += 1;
        }
        other
    }

    /// Every row times its factor of `rows`, every column over its factor of `columns`: a change of units.
    #[must_use]
    pub const fn scaled(&self, rows: &[f64; R], columns: &[f64; C]) -> Self {
        let mut other = *self;
        let mut i = 0;
        while i < R {
            let mut j = 0;
            while j < C {
                other.0[i][j] = other.0[i][j] * rows[i] / columns[j];
                j += 1;
            }
            i += 1;
        }
        other
    }

    /// The largest sum of sizes down a column.
    #[must_use]
    pub const fn norm(&self) -> f64 {
        let mut largest = 0.0;
        let mut j = 0;
        while j < C {
            let mut sum = 0.0;
            let mut i = 0;
            while i < R {
                sum += self.0[i][j].abs();
                i += 1;
            }
            if sum > largest || sum.is_nan() {
                largest = sum;
            }
            j += 1;
        }
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
        let mut i = 0;
        while i < N {
            matrix.0[i][i] = values[i];
            i += 1;
        }
        matrix
    }

    /// The mean of the matrix and its transpose.
    #[must_use]
    pub const fn symmetric(&self) -> Self {
        let mut other = *self;
        let mut i = 0;
        while i < N {
            let mut j = 0;
            while j < N {
                other.0[i][j] = 0.5 * (self.0[i][j] + self.0[j][i]);
                j += 1;
            }
            i += 1;
        }
        other
    }

    /// `X` in `self * X = right`, by LU with row exchanges; `None` where the matrix is singular.
    #[must_use]
    pub const fn solve<const K: usize>(&self, right: &Matrix<N, K>) -> Option<Matrix<N, K>> {
        let mut lu = *self;
        let mut x = *right;
        let mut pivot = 0;
        while pivot < N {
            let mut best = pivot;
            let mut i = pivot + 1;
            while i < N {
                if lu.0[i][pivot].abs() > lu.0[best][pivot].abs() {
                    best = i;
                }
                i += 1;
            }
            if lu.0[best][pivot] == 0.0 || !lu.0[best][pivot].is_finite() {
                return None;
            }
            lu.0.swap(pivot, best);
            x.0.swap(pivot, best);
            let mut i = pivot + 1;
            while i < N {
                let factor = lu.0[i][pivot] / lu.0[pivot][pivot];
                if factor != 0.0 {
                    let mut j = pivot + 1;
                    while j < N {
                        lu.0[i][j] -= factor * lu.0[pivot][j];
                        j += 1;
                    }
                    let mut k = 0;
                    while k < K {
                        x.0[i][k] -= factor * x.0[pivot][k];
                        k += 1;
                    }
                }
                i += 1;
            }
            pivot += 1;
        }
        let mut row = N;
        while row > 0 {
            row -= 1;
            let mut k = 0;
            while k < K {
                let mut sum = x.0[row][k];
                let mut j = row + 1;
                while j < N {
                    sum -= lu.0[row][j] * x.0[j][k];
                    j += 1;
                }
                x.0[row][k] = sum / lu.0[row][row];
                k += 1;
            }
        }
        Some(x)
    }
}
