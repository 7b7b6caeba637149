//! Small matrices and lists whose access cannot fail: outside there is zero, and nothing to write to.
//!
//! The linker refuses an image in which a panic can be reached; so nothing here is indexed by a run-time value.

use super::scalar::{Complex, Scalar, square, zero};

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Matrix<T: Scalar, const ROWS: usize, const COLUMNS: usize>([[Complex<T>; COLUMNS]; ROWS]);

impl<T: Scalar, const ROWS: usize, const COLUMNS: usize> Matrix<T, ROWS, COLUMNS> {
    pub(crate) fn new() -> Self {
        Matrix([[zero(); COLUMNS]; ROWS])
    }

    pub(crate) fn of(rows: [[Complex<T>; COLUMNS]; ROWS]) -> Self {
        Matrix(rows)
    }

    pub(crate) fn rows(&self) -> [[Complex<T>; COLUMNS]; ROWS] {
        self.0
    }

    pub(crate) fn at(&self, row: usize, column: usize) -> Complex<T> {
        self.0.get(row).and_then(|row| row.get(column)).copied().unwrap_or(zero())
    }

    pub(crate) fn set(&mut self, row: usize, column: usize, value: Complex<T>) {
        if let Some(at) = self.0.get_mut(row).and_then(|row| row.get_mut(column)) {
            *at = value;
        }
    }

    /// Norm of a column from a row on.
    pub(crate) fn norm_from(&self, row: usize, column: usize) -> T {
        (row..ROWS).fold(T::zero(), |sum, row| sum + square(self.at(row, column))).sqrt()
    }

    pub(crate) fn swap_columns(&mut self, a: usize, b: usize) {
        for row in 0..ROWS {
            let (x, y) = (self.at(row, a), self.at(row, b));
            self.set(row, a, y);
            self.set(row, b, x);
        }
    }
}

/// The value at an index, or another where there is none.
pub(crate) fn pick<V: Copy>(list: &[V], index: usize, or: V) -> V {
    list.get(index).copied().unwrap_or(or)
}

pub(crate) fn put<V>(list: &mut [V], index: usize, value: V) {
    if let Some(at) = list.get_mut(index) {
        *at = value;
    }
}

pub(crate) fn swap<V: Copy>(list: &mut [V], a: usize, b: usize) {
    if let (Some(x), Some(y)) = (list.get(a).copied(), list.get(b).copied()) {
        put(list, a, y);
        put(list, b, x);
    }
}
