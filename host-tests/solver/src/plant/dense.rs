//! Small dense matrices, row by row, with just the products that the solver needs.

/// A matrix of `rows` x `cols`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Dense {
    pub rows: usize,
    pub cols: usize,
    values: Vec<f64>,
}

impl Dense {
    pub fn zeros(rows: usize, cols: usize) -> Self {
        Self { rows, cols, values: vec![0.0; rows * cols] }
    }

    pub fn get(&self, row: usize, col: usize) -> f64 {
        self.values[row * self.cols + col]
    }

    pub fn set(&mut self, row: usize, col: usize, value: f64) {
        self.values[row * self.cols + col] = value;
    }

    pub fn add(&mut self, row: usize, col: usize, value: f64) {
        self.values[row * self.cols + col] += value;
    }

    pub fn row(&self, row: usize) -> &[f64] {
        &self.values[row * self.cols..(row + 1) * self.cols]
    }

    pub fn clear_row(&mut self, row: usize) {
        let cols = self.cols;
        self.values[row * cols..(row + 1) * cols].fill(0.0);
    }

    pub fn clear_column(&mut self, col: usize) {
        for row in 0..self.rows {
            self.set(row, col, 0.0);
        }
    }

    /// `out = M v`.
    pub fn times(&self, v: &[f64], out: &mut [f64]) {
        for (o, row) in out.iter_mut().zip(self.values.chunks_exact(self.cols)) {
            *o = dot(row, v);
        }
    }

    /// `out = |M| v`, every entry by its magnitude.
    pub fn magnitude_times(&self, v: &[f64], out: &mut [f64]) {
        for (o, row) in out.iter_mut().zip(self.values.chunks_exact(self.cols)) {
            *o = row.iter().zip(v).map(|(a, b)| a.abs() * b).sum();
        }
    }

    /// `v^T M`.
    pub fn left_times(&self, v: &[f64]) -> Vec<f64> {
        (0..self.cols).map(|c| (0..self.rows).map(|r| v[r] * self.get(r, c)).sum()).collect()
    }

    pub fn product(&self, other: &Dense) -> Dense {
        let mut out = Dense::zeros(self.rows, other.cols);
        for r in 0..self.rows {
            for (k, &a) in self.row(r).iter().enumerate().filter(|(_, a)| **a != 0.0) {
                for c in 0..other.cols {
                    out.add(r, c, a * other.get(k, c));
                }
            }
        }
        out
    }

    pub fn map(&self, change: impl Fn(usize, usize, f64) -> f64) -> Dense {
        let mut out = self.clone();
        for r in 0..self.rows {
            for c in 0..self.cols {
                out.set(r, c, change(r, c, self.get(r, c)));
            }
        }
        out
    }

    /// Largest sum of the magnitudes of a row.
    pub fn row_norm(&self) -> f64 {
        (0..self.rows).map(|r| self.row(r).iter().map(|v| v.abs()).sum::<f64>()).fold(0.0, f64::max)
    }

    /// The columns from `first` on, `cols` of them, of the first `rows` rows.
    pub fn block(&self, rows: usize, first: usize, cols: usize) -> Dense {
        let mut out = Dense::zeros(rows, cols);
        for r in 0..rows {
            for c in 0..cols {
                out.set(r, c, self.get(r, first + c));
            }
        }
        out
    }
}

/// Scalar product.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
