//! Matrices whose entries stand near the diagonal, as those of a shaft do, and their factors.

use nalgebra::ComplexField;

/// A square matrix with entries up to `half` places beside the diagonal.
#[derive(Clone, Debug)]
pub(super) struct Band<T> {
    size: usize,
    half: usize,
    /// Row after row from `half` places before the diagonal to `2 half` behind it, where row exchanges fill in.
    entries: Vec<T>,
}

/// The factors of a matrix, by rows that were exchanged for the largest pivot.
pub(super) struct Factors<T> {
    band: Band<T>,
    exchanged: Vec<usize>,
}

impl<T: ComplexField<RealField = f64> + Copy> Band<T> {
    /// The matrix with these entries.
    pub fn new(size: usize, half: usize, entry: impl Fn(usize, usize) -> T) -> Self {
        let mut band = Band { size, half, entries: vec![T::zero(); size * (3 * half + 1)] };
        for column in 0..size {
            for row in column.saturating_sub(half)..(column + half + 1).min(size) {
                let at = band.at(row, column);
                band.entries[at] = entry(row, column);
            }
        }
        band
    }

    #[inline]
    const fn at(&self, row: usize, column: usize) -> usize {
        row * (3 * self.half + 1) + column + self.half - row
    }

    fn beside(&self, row: usize) -> std::ops::Range<usize> {
        row.saturating_sub(self.half)..(row + self.half + 1).min(self.size)
    }

    /// The entry in this place.
    #[inline]
    pub fn get(&self, row: usize, column: usize) -> T {
        self.entries[self.at(row, column)]
    }

    /// Size, and places beside the diagonal.
    pub const fn shape(&self) -> (usize, usize) {
        (self.size, self.half)
    }

    /// The product with a vector.
    pub fn times(&self, x: &[T]) -> Vec<T> {
        let row = |row: usize| {
            let across = self.beside(row);
            let entries = &self.entries[self.at(row, across.start)..];
            entries.iter().zip(&x[across]).fold(T::zero(), |sum, (&a, &x)| sum + a * x)
        };
        (0..self.size).map(row).collect()
    }

    /// The product of the conjugate transpose with a vector.
    pub fn adjoint_times(&self, x: &[T]) -> Vec<T> {
        let mut sum = vec![T::zero(); self.size];
        for (row, &x) in x.iter().enumerate() {
            for column in self.beside(row) {
                sum[column] += self.get(row, column).conjugate() * x;
            }
        }
        sum
    }

    pub fn factors(self) -> Factors<T> {
        self.eliminated(true)
    }

    /// The factors of a symmetric matrix that is positive; `None` of another one.
    pub fn positive(self) -> Option<Factors<T>> {
        let factors = self.eliminated(false);
        let pivots = (0..factors.band.size).all(|k| factors.band.get(k, k).real() > 0.0);
        pivots.then_some(factors)
    }

    /// Negative eigenvalues of a Hermitian matrix, by Sylvester's law from the pivots; `None` where one is not finite.
    pub fn negative(self) -> Option<usize> {
        let factors = self.eliminated(false);
        let pivots = (0..factors.band.size).map(|k| factors.band.get(k, k).real());
        pivots.map(|pivot| pivot.is_finite().then_some(usize::from(pivot < 0.0))).sum()
    }

    fn eliminated(mut self, exchange: bool) -> Factors<T> {
        let (n, half) = self.shape();
        let mut exchanged = Vec::with_capacity(n);
        for k in 0..n {
            let below = k + 1..(k + half + 1).min(n);
            let size = |row: usize| self.get(row, k).norm1();
            let larger = |best, row| if exchange && size(row) > size(best) { row } else { best };
            let pivot = below.clone().fold(k, larger);
            exchanged.push(pivot);
            let width = (k + 2 * half + 1).min(n) - k;
            let first = self.at(k, k);
            if pivot != k {
                let other = self.at(pivot, k);
                (0..width).for_each(|offset| self.entries.swap(first + offset, other + offset));
            }
            let own = self.entries[first];
            for row in below {
                let start = self.at(row, k);
                let factor = self.entries[start] / own;
                self.entries[start] = factor;
                if factor != T::zero() {
                    let (upper, lower) = self.entries.split_at_mut(start);
                    let pairs = lower[1..width].iter_mut().zip(&upper[first + 1..first + width]);
                    pairs.for_each(|(entry, &above)| *entry -= factor * above);
                }
            }
        }
        Factors { band: self, exchanged }
    }
}

impl<T: ComplexField<RealField = f64> + Copy> Factors<T> {
    /// The determinant over its size.
    pub fn phase(&self) -> T {
        let pivots = (0..self.band.size).zip(&self.exchanged).map(|(k, &other)| {
            let pivot = self.band.get(k, k);
            pivot.unscale(if k == other { pivot.modulus() } else { -pivot.modulus() })
        });
        pivots.fold(T::one(), |product, pivot| product * pivot)
    }

    /// `x` of `A x = b`; not finite where `A` is singular.
    pub fn solve(&self, mut x: Vec<T>) -> Vec<T> {
        let (n, half) = self.band.shape();
        for k in 0..n {
            x.swap(k, self.exchanged[k]);
            for row in k + 1..(k + half + 1).min(n) {
                let by = self.band.get(row, k) * x[k];
                x[row] -= by;
            }
        }
        for k in (0..n).rev() {
            let right = k + 1..(k + 2 * half + 1).min(n);
            let entries = &self.band.entries[self.band.at(k, k)..];
            let known = entries[1..].iter().zip(&x[right]).fold(T::zero(), |sum, (&a, &x)| sum + a * x);
            x[k] = (x[k] - known) / entries[0];
        }
        x
    }

    /// `x` of `A^H x = b`.
    pub fn solve_adjoint(&self, mut x: Vec<T>) -> Vec<T> {
        let (n, half) = self.band.shape();
        for k in 0..n {
            x[k] /= self.band.get(k, k).conjugate();
            for column in k + 1..(k + 2 * half + 1).min(n) {
                let by = self.band.get(k, column).conjugate() * x[k];
                x[column] -= by;
            }
        }
        for k in (0..n).rev() {
            for row in k + 1..(k + half + 1).min(n) {
                let by = self.band.get(row, k).conjugate() * x[row];
                x[k] -= by;
            }
            x.swap(k, self.exchanged[k]);
        }
        x
    }

    /// Of a positive matrix `R R^H`: `R^-1 x`.
    pub fn half(&self, mut x: Vec<T>) -> Vec<T> {
        let (n, half) = self.band.shape();
        for k in 0..n {
            for row in k + 1..(k + half + 1).min(n) {
                let by = self.band.get(row, k) * x[k];
                x[row] -= by;
            }
            x[k] = x[k].unscale(self.band.get(k, k).real().sqrt());
        }
        x
    }

    /// Of a positive matrix `R R^H`: `R^-H x`.
    pub fn half_adjoint(&self, mut x: Vec<T>) -> Vec<T> {
        let (n, half) = self.band.shape();
        for k in (0..n).rev() {
            x[k] = x[k].unscale(self.band.get(k, k).real().sqrt());
            for row in k + 1..(k + half + 1).min(n) {
                let by = self.band.get(row, k).conjugate() * x[row];
                x[k] -= by;
            }
        }
        x
    }

    /// Of a positive matrix `R R^H`: `R^H x`.
    pub fn half_times(&self, x: &[T]) -> Vec<T> {
        let (n, half) = self.band.shape();
        let entry = |k: usize| {
            let below = k + 1..(k + half + 1).min(n);
            let sum = below.fold(x[k], |sum, row| sum + self.band.get(row, k).conjugate() * x[row]);
            sum.scale(self.band.get(k, k).real().sqrt())
        };
        (0..n).map(entry).collect()
    }
}
