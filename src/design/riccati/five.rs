//! Matrices of five rows and columns, written out.
//!
//! The compiler interprets a design. An element that is read by an index costs it as much as several multiplications,
//! so here each is read once, by a pattern. Operations and their order are those of the loops of [`Matrix`], and so are
//! the bits.

use super::Matrix;

pub(super) type Square = [[f64; 5]; 5];

pub(super) const UNIT: Square = [
    [1.0, 0.0, 0.0, 0.0, 0.0],
    [0.0, 1.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, 1.0, 0.0, 0.0],
    [0.0, 0.0, 0.0, 1.0, 0.0],
    [0.0, 0.0, 0.0, 0.0, 1.0],
];

/// A matrix of this size; `None` for another.
pub(super) const fn square<const N: usize>(matrix: &Matrix<N, N>) -> Option<Square> {
    let mut square = [[0.0; 5]; 5];
    each!(i, 0.., N == 5 && i < N, {
        match (&matrix.0[i] as &[f64]).first_chunk() {
            Some(row) => square[i] = *row,
            None => return None,
        }
    });
    if N == 5 { Some(square) } else { None }
}

/// The same as a matrix of any size: the inverse of [`square`].
pub(super) const fn matrix<const N: usize>(square: &Square) -> Matrix<N, N> {
    let mut matrix = Matrix::ZERO;
    each!(i, 0.., i < N && i < 5, {
        each!(j, 0.., j < N && j < 5, {
            matrix.0[i][j] = square[i][j];
        });
    });
    matrix
}

pub(super) const fn product(left: &Square, right: &Square) -> Square {
    let [[a0, a1, a2, a3, a4], [b0, b1, b2, b3, b4], [c0, c1, c2, c3, c4], [d0, d1, d2, d3, d4], [e0, e1, e2, e3, e4]] =
        *right;
    let mut product = [[0.0; 5]; 5];
    each!(i, 0..5, {
        let [x0, x1, x2, x3, x4] = left[i];
        product[i] = [
            0.0 + x0 * a0 + x1 * b0 + x2 * c0 + x3 * d0 + x4 * e0,
            0.0 + x0 * a1 + x1 * b1 + x2 * c1 + x3 * d1 + x4 * e1,
            0.0 + x0 * a2 + x1 * b2 + x2 * c2 + x3 * d2 + x4 * e2,
            0.0 + x0 * a3 + x1 * b3 + x2 * c3 + x3 * d3 + x4 * e3,
            0.0 + x0 * a4 + x1 * b4 + x2 * c4 + x3 * d4 + x4 * e4,
        ];
    });
    product
}

pub(super) const fn sum(left: &Square, right: &Square) -> Square {
    let mut sum = *left;
    each!(i, 0..5, {
        let ([x0, x1, x2, x3, x4], [y0, y1, y2, y3, y4]) = (left[i], right[i]);
        sum[i] = [x0 + y0, x1 + y1, x2 + y2, x3 + y3, x4 + y4];
    });
    sum
}

pub(super) const fn transpose(square: &Square) -> Square {
    let [[a0, a1, a2, a3, a4], [b0, b1, b2, b3, b4], [c0, c1, c2, c3, c4], [d0, d1, d2, d3, d4], [e0, e1, e2, e3, e4]] =
        *square;
    [[a0, b0, c0, d0, e0], [a1, b1, c1, d1, e1], [a2, b2, c2, d2, e2], [a3, b3, c3, d3, e3], [a4, b4, c4, d4, e4]]
}

pub(super) const fn symmetric(square: &Square) -> Square {
    let mut twice = sum(square, &transpose(square));
    each!(i, 0..5, {
        let [x0, x1, x2, x3, x4] = twice[i];
        twice[i] = [0.5 * x0, 0.5 * x1, 0.5 * x2, 0.5 * x3, 0.5 * x4];
    });
    twice
}

pub(super) const fn diagonal(square: &Square) -> [f64; 5] {
    let [[a, ..], [_, b, ..], [_, _, c, ..], [_, _, _, d, _], [.., e]] = *square;
    [a, b, c, d, e]
}

/// Whether no sum of sizes down a column overflows, and every element is a number.
pub(super) const fn is_finite(square: &Square) -> bool {
    let mut sums = [0.0; 5];
    each!(i, 0..5, {
        let ([x0, x1, x2, x3, x4], [y0, y1, y2, y3, y4]) = (square[i], sums);
        sums = [y0 + x0.abs(), y1 + x1.abs(), y2 + x2.abs(), y3 + x3.abs(), y4 + x4.abs()];
    });
    let [a, b, c, d, e] = sums;
    a < f64::INFINITY && b < f64::INFINITY && c < f64::INFINITY && d < f64::INFINITY && e < f64::INFINITY
}

/// Solves `left * X = right` for several right sides, by LU with row exchanges.
pub(super) struct Solver {
    /// The rows of a right side in the order of the pivots.
    order: [usize; 5],
    /// Multipliers below the diagonal, the upper triangle on and above it.
    lu: Square,
}

impl Solver {
    /// `None` where the matrix is singular. Rows are compared with their elements times `weights`.
    pub(super) const fn new(left: &Square, mut weights: [f64; 5]) -> Option<Self> {
        let (mut lu, mut order) = (*left, [0, 1, 2, 3, 4]);
        each!(pivot, 0..5, {
            let mut best = pivot;
            let mut largest = (lu[pivot][pivot] * weights[pivot]).abs();
            each!(i, (pivot + 1)..5, {
                let size = (lu[i][pivot] * weights[i]).abs();
                if size > largest {
                    (best, largest) = (i, size);
                }
            });
            // The bound holds anyway: it is there for the compiler, which then leaves no panic in an image.
            if largest == 0.0 || !largest.is_finite() || best >= 5 {
                return None;
            }
            let (upper, place) = (lu[best], order[best]);
            (lu[best], order[best], weights[best]) = (lu[pivot], order[pivot], weights[pivot]);
            (lu[pivot], order[pivot]) = (upper, place);
            let [_, g, h, k, l] = upper;
            each!(i, (pivot + 1)..5, {
                let factor = lu[i][pivot] / upper[pivot];
                let [a, b, c, d, e] = lu[i];
                lu[i] = match pivot {
                    0 => [factor, b - factor * g, c - factor * h, d - factor * k, e - factor * l],
                    1 => [a, factor, c - factor * h, d - factor * k, e - factor * l],
                    2 => [a, b, factor, d - factor * k, e - factor * l],
                    _ => [a, b, c, factor, e - factor * l],
                };
            });
        });
        Some(Self { order, lu })
    }

    /// The transpose of X, from the transpose of the right side.
    pub(super) const fn columns(&self, right: &Square) -> Square {
        let [p, q, r, s, t] = self.order;
        let [
            [a0, a1, a2, a3, a4],
            [b0, b1, b2, b3, b4],
            [c0, c1, c2, c3, c4],
            [d0, d1, d2, d3, d4],
            [e0, e1, e2, e3, e4],
        ] = self.lu;
        let mut solved = [[0.0; 5]; 5];
        each!(i, 0..5, {
            let column = &right[i];
            let a = at(column, p);
            let b = at(column, q) - b0 * a;
            let c = at(column, r) - c0 * a - c1 * b;
            let d = at(column, s) - d0 * a - d1 * b - d2 * c;
            let e = at(column, t) - e0 * a - e1 * b - e2 * c - e3 * d;
            let e = e / e4;
            let d = (d - d4 * e) / d3;
            let c = (c - c3 * d - c4 * e) / c2;
            let b = (b - b2 * c - b3 * d - b4 * e) / b1;
            let a = (a - a1 * b - a2 * c - a3 * d - a4 * e) / a0;
            solved[i] = [a, b, c, d, e];
        });
        solved
    }
}

/// An element of a column; without a bound that could be missed, since an image may hold no panic.
const fn at(column: &[f64; 5], place: usize) -> f64 {
    let [a, b, c, d, e] = *column;
    match place {
        0 => a,
        1 => b,
        2 => c,
        3 => d,
        _ => e,
    }
}
