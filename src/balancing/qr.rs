//! Least squares by orthogonal factorisation, a row at a time.
//!
//! Givens rotations take each row into a triangle of `PLANES` rows (Golub and Van Loan, *Matrix Computations*, 5.2.3
//! and 6.5); so any number of rows needs no more room, and `A^H A`, whose condition is the square, is never formed.
//! Columns are then pivoted by Householder reflections (5.4.2), which shows dependent columns.

use nalgebra::ComplexField;

use super::matrix::{Matrix, pick, put, swap};
use super::scalar::{Complex, Scalar, real, size, square, zero};

/// The triangle of the rows so far and their right side: `R x = z` is the least-squares solution of `A x = b`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Qr<T: Scalar, const PLANES: usize> {
    r: Matrix<T, PLANES, PLANES>,
    z: [Complex<T>; PLANES],
    /// Sum of the squares that no solution takes away.
    pub(crate) rest: T,
}

/// An upper triangle with its columns in the order of the pivots.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PivotedQr<T: Scalar, const PLANES: usize> {
    qr: Qr<T, PLANES>,
    pub(crate) order: [usize; PLANES],
    /// Columns that are independent.
    pub(crate) rank: usize,
    /// Norms that the columns were divided by.
    scale: [T; PLANES],
}

impl<T: Scalar, const PLANES: usize> Qr<T, PLANES> {
    pub(crate) fn new() -> Self {
        Qr { r: Matrix::new(), z: [zero(); PLANES], rest: T::zero() }
    }

    /// Takes in a row `a x = b`.
    pub(crate) fn absorb(&mut self, a: &[Complex<T>; PLANES], b: Complex<T>) {
        let (mut a, mut b) = (*a, b);
        for k in 0..PLANES {
            let (diagonal, out) = (self.r.at(k, k).re, pick(&a, k, zero()));
            if out == zero() {
                continue;
            }
            let radius = size(Complex { re: diagonal, im: size(out) });
            let (c, s) = (diagonal / radius, out.unscale(radius));
            let turned =
                |above: Complex<T>, below: Complex<T>| (above.scale(c) + s.conj() * below, below.scale(c) - s * above);
            for (j, a) in a.iter_mut().enumerate().skip(k + 1) {
                let (above, below) = turned(self.r.at(k, j), *a);
                self.r.set(k, j, above);
                *a = below;
            }
            self.r.set(k, k, Complex { re: radius, im: T::zero() });
            let (above, below) = turned(pick(&self.z, k, zero()), b);
            put(&mut self.z, k, above);
            b = below;
        }
        self.rest += square(b);
    }

    /// Norm of what column `k` has beside the columns before it.
    pub(crate) fn own(&self, k: usize) -> T {
        size(self.r.at(k, k))
    }

    /// Puts the columns, each divided by its norm, in order: first the one that has most beside those before it; of
    /// columns alike in that share, which may do the same, the one of the largest norm [Darlow 1982]. A column with no
    /// more of its own than the share `independence` counts as dependent.
    pub(crate) fn pivoted(mut self, independence: T) -> PivotedQr<T, PLANES> {
        let mut scale = [T::one(); PLANES];
        for (j, scale) in scale.iter_mut().enumerate() {
            let norm = self.r.norm_from(0, j);
            if norm > T::zero() {
                *scale = norm;
                for k in 0..=j {
                    self.r.set(k, j, self.r.at(k, j).unscale(norm));
                }
            }
        }
        let mut order = [0; PLANES];
        for (j, plane) in order.iter_mut().enumerate() {
            *plane = j;
        }
        let mut rank = 0;
        // Rounding alone leaves as much as this of a dependent column.
        let independence = independence.max(T::default_epsilon() * real(4.0 * PLANES as f64));
        // Columns that do the same differ by up to the independence. A tie is decided by the order of the planes,
        // whatever rounding makes of it.
        let alike = independence.max(real(0.001));
        while rank < PLANES {
            let (mut best, mut own) = (rank, self.r.norm_from(rank, rank));
            for j in rank + 1..PLANES {
                let other = self.r.norm_from(rank, j);
                let [size, norm] = [j, best].map(|k| pick(&scale, k, T::one()));
                let same = own > independence && (other - own).abs() <= alike;
                if other > independence && if same { size > norm * real(1.001) } else { other > own } {
                    (best, own) = (j, other);
                }
            }
            if !(own > independence) {
                break;
            }
            self.r.swap_columns(rank, best);
            swap(&mut order, rank, best);
            swap(&mut scale, rank, best);
            self.reflect(rank);
            rank += 1;
        }
        PivotedQr { qr: self, order, rank, scale }
    }

    /// Reflects the rows from `k` on so that column `k` ends there.
    fn reflect(&mut self, k: usize) {
        let norm = self.r.norm_from(k, k);
        let head = self.r.at(k, k);
        let ahead = Complex { re: T::one(), im: T::zero() };
        let away = if size(head) > T::zero() { head.unscale(size(head)) } else { ahead };
        let mut v = [zero(); PLANES];
        for (i, v) in v.iter_mut().enumerate().skip(k) {
            *v = self.r.at(i, k);
        }
        put(&mut v, k, head + away.scale(norm));
        let length = v.iter().fold(T::zero(), |sum, v| sum + square(*v));
        let two = real::<T>(2.0) / length;
        for j in k..PLANES {
            let along = v.iter().enumerate().fold(zero(), |sum, (i, v)| sum + v.conj() * self.r.at(i, j)).scale(two);
            for (i, v) in v.iter().enumerate() {
                self.r.set(i, j, self.r.at(i, j) - *v * along);
            }
        }
        let along = v.iter().zip(&self.z).fold(zero(), |sum, (v, z)| sum + v.conj() * *z).scale(two);
        for (z, v) in self.z.iter_mut().zip(&v) {
            *z -= *v * along;
        }
    }
}

impl<T: Scalar, const PLANES: usize> PivotedQr<T, PLANES> {
    /// The solution with the dependent columns at zero.
    pub(crate) fn solve(&self) -> [Complex<T>; PLANES] {
        let y = self.back(|k| pick(&self.qr.z, k, zero()));
        let mut x = [zero(); PLANES];
        for (k, y) in y.iter().enumerate().take(self.rank) {
            put(&mut x, pick(&self.order, k, PLANES), y.unscale(pick(&self.scale, k, T::one())));
        }
        x
    }

    /// Column `j` in the order of the pivots, behind the rank: its independent share, and the combination of the
    /// independent planes that gives the rest.
    pub(crate) fn combination(&self, j: usize) -> (T, [Complex<T>; PLANES]) {
        let y = self.back(|k| self.qr.r.at(k, j));
        let mut x = [zero(); PLANES];
        for (k, y) in y.iter().enumerate().take(self.rank) {
            let scale = pick(&self.scale, j, T::one()) / pick(&self.scale, k, T::one());
            put(&mut x, pick(&self.order, k, PLANES), y.scale(scale));
        }
        (self.qr.r.norm_from(self.rank, j), x)
    }

    /// Back substitution among the independent columns.
    fn back(&self, right: impl Fn(usize) -> Complex<T>) -> [Complex<T>; PLANES] {
        let mut y = [zero(); PLANES];
        for k in (0..PLANES).rev() {
            if k < self.rank {
                let mut sum = right(k);
                for (j, known) in y.iter().enumerate().skip(k + 1) {
                    sum -= self.qr.r.at(k, j) * *known;
                }
                put(&mut y, k, sum / self.qr.r.at(k, k));
            }
        }
        y
    }

    /// Greatest over least singular value of the independent columns as they were, by one-sided Jacobi rotations (Golub
    /// and Van Loan, 8.6.3).
    pub(crate) fn condition(&self) -> T {
        let mut a = Matrix::<T, PLANES, PLANES>::new();
        for (j, scale) in self.scale.iter().enumerate().take(self.rank) {
            for i in 0..=j {
                a.set(i, j, self.qr.r.at(i, j).scale(*scale));
            }
        }
        // Forty sweeps are far more than the five or six that are needed.
        for _ in 0..40 {
            let mut turned = false;
            for p in 0..self.rank {
                for q in p + 1..self.rank {
                    turned |= orthogonalise(&mut a, p, q);
                }
            }
            if !turned {
                break;
            }
        }
        let (mut least, mut most) = (T::max_value().unwrap_or(T::one()), T::zero());
        for j in 0..self.rank {
            let value = a.norm_from(0, j);
            least = least.min(value);
            most = most.max(value);
        }
        if self.rank == 0 { T::one() } else { most / least }
    }
}

/// Turns two columns so that they are orthogonal; false where they are.
fn orthogonalise<T: Scalar, const PLANES: usize>(a: &mut Matrix<T, PLANES, PLANES>, p: usize, q: usize) -> bool {
    let (alpha, beta) = (a.norm_from(0, p), a.norm_from(0, q));
    let gamma = (0..PLANES).fold(zero(), |sum, i| sum + a.at(i, p).conj() * a.at(i, q));
    let across = size(gamma);
    if !(across > T::default_epsilon() * real::<T>(8.0) * alpha * beta) {
        return false;
    }
    let zeta = (beta - alpha) * (beta + alpha) / (across + across);
    let sign = if zeta < T::zero() { -T::one() } else { T::one() };
    let t = sign / (zeta.abs() + (T::one() + zeta * zeta).sqrt());
    let c = T::one() / (T::one() + t * t).sqrt();
    let (s, phase) = (c * t, gamma.unscale(across));
    for i in 0..PLANES {
        let (x, y) = (a.at(i, p), a.at(i, q) * phase.conj());
        a.set(i, p, x.scale(c) - y.scale(s));
        a.set(i, q, x.scale(s) + y.scale(c));
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn re(re: f64) -> Complex<f64> {
        Complex { re, im: 0.0 }
    }

    /// Of columns.
    fn of<const N: usize>(columns: [[f64; N]; N], right: [f64; N]) -> Qr<f64, N> {
        let mut qr = Qr::new();
        for (row, right) in right.into_iter().enumerate() {
            qr.absorb(&columns.map(|column| re(column[row])), re(right));
        }
        qr
    }

    /// Shares of their own are of the columns' own sizes.
    #[test]
    fn a_small_column_is_independent() {
        let pivoted = of([[1.0, 0.0], [0.0, 1e-9]], [2.0, 3e-9]).pivoted(1e-6);
        assert_eq!((pivoted.rank, pivoted.order), (2, [0, 1]));
        // one division and one product
        let [x, y] = pivoted.solve();
        assert!((x - re(2.0)).norm_sqr() < 1e-30 && (y - re(3.0)).norm_sqr() < 1e-30, "{x} {y}");
    }

    /// With a share of four epsilon for each of two planes, or with the share that is asked for, a column is dependent.
    #[test]
    fn a_column_without_a_share_of_its_own_is_dependent() {
        let rank = |column: [f64; 2], independence: f64| of([[1.0, 0.0], column], [0.0; 2]).pivoted(independence).rank;
        let share = |epsilons: f64| rank([1.0, epsilons * f64::EPSILON], 0.0);
        assert_eq!([share(1.5), share(7.0), share(9.0)], [1, 1, 2]);
        // 3, 4 and 5
        assert_eq!([rank([3.0, 4.0], 0.8), rank([3.0, 4.0], 0.79)], [1, 2]);
    }

    /// Of columns that do the same, exactly or but for less than the independence, the larger one is a pivot, whichever
    /// comes first and whatever is beside them.
    #[test]
    fn of_two_planes_that_do_the_same_the_more_effective_one_is_kept() {
        for (near, independence) in [(0.0, 0.0), (0.0, 0.01), (0.005, 0.01)] {
            for (first, second) in [(1.0_f64, 3.0_f64), (3.0, 1.0), (1e-6, 1.0)] {
                let small = first.min(second);
                let kept = if first > second { 0 } else { 1 };
                let pair = [[first, 0.0, 0.0], [second * (1.0_f64 - near * near).sqrt(), second * near, 0.0]];
                let two = of([[pair[0][0], pair[0][1]], [pair[1][0], pair[1][1]]], [0.0; 2]).pivoted(independence);
                assert_eq!((two.rank, two.order[0]), (1, kept), "{near} {first} {second}");
                // beside one that is larger and has some of both
                let other = [small, 0.0, 10.0];
                let three = of([pair[0], other, pair[1]], [0.0; 3]).pivoted(independence);
                assert_eq!((three.rank, three.order[2]), (2, if kept == 0 { 2 } else { 0 }), "{near} {first} {second}");
            }
        }
    }

    /// The second pivot is the column with most beside the first, if that is more by a thousandth.
    #[test]
    fn pivots_are_in_order() {
        let order = |second: f64, third: f64| {
            let column = |own: f64, at: usize| {
                let mut column = [(1.0 - own * own).sqrt(), 0.0, 0.0];
                column[at] = own;
                column
            };
            of([[1.0, 0.0, 0.0], column(second, 1), column(third, 2)], [0.0; 3]).pivoted(0.0).order
        };
        assert_eq!([order(0.5, 0.8), order(0.8, 0.5)], [[0, 2, 1], [0, 1, 2]]);
        assert_eq!([order(0.5, 0.5002), order(0.5, 0.502)], [[0, 1, 2], [0, 2, 1]]);
    }

    #[test]
    fn a_plane_without_effect_is_left_out() {
        let pivoted = of([[0.0, 0.0], [2.0, 0.0]], [4.0, 0.0]).pivoted(0.0);
        let [x, y] = pivoted.solve();
        assert_eq!((pivoted.rank, x), (1, re(0.0)));
        assert!((y - re(2.0)).norm_sqr() < 1e-30, "{y}");
    }

    /// The singular values of `[[a, b], [0, c]]` are those of `s^4 - (a^2 + b^2 + c^2) s^2 + a^2 c^2`.
    #[test]
    fn the_condition_is_that_of_the_closed_form() {
        for [a, b, c] in [[1.0, 0.5, 0.5], [1.0, 3.0, 0.5], [1.0, 0.6, 0.8], [2.0, 0.5, 0.1], [0.2, 0.5, 3.0]] {
            for size in [1.0, 1e-10, 1e10] {
                let found = of([[size * a, 0.0], [size * b, size * c]], [0.0; 2]).pivoted(0.0).condition();
                let sum: f64 = a * a + b * b + c * c;
                let apart = (sum * sum - 4.0 * a * a * c * c).sqrt();
                // the greater over the least, whose product is a c
                let expected = (sum + apart) / (2.0 * a * c);
                // rounding of the least singular value, a tenth of the greatest and less
                assert!((found / expected - 1.0).abs() < 1e-13, "{a} {b} {c} {size}: {found} {expected}");
            }
        }
    }

    /// Beside (10, 0, 0), the largest, and (0, 1, d) the column (4, 3, 0) has 3 d of its own, 0.6 d of its length, but for d^2. A
    /// reflection that took a difference of the head and the norm, which are equal but for d^2/2, would lose it.
    #[test]
    fn a_reflection_loses_nothing() {
        let d = 1e-9;
        let pivoted = of([[10.0, 0.0, 0.0], [4.0, 3.0, 0.0], [0.0, 1.0, d]], [0.0; 3]).pivoted(0.01);
        assert_eq!((pivoted.order, pivoted.rank), ([0, 2, 1], 2));
        let (own, like) = pivoted.combination(2);
        // some units in the last place
        assert!((own / (0.6 * d) - 1.0).abs() < 1e-14, "{own}");
        // 0.4 of the first and three of the third
        let expected = [re(0.4), re(0.0), re(3.0)];
        assert!(like.iter().zip(expected).all(|(like, expected)| (*like - expected).norm_sqr() < 1e-28), "{like:?}");
    }

    /// A pivot with nothing in its row: the third column beside the first, before the second. The solution is ones.
    #[test]
    fn a_reflection_begins_with_a_zero() {
        let pivoted = of([[10.0, 0.0, 0.0], [4.0, 3.0, 0.0], [0.0, 0.0, 2.0]], [14.0, 3.0, 2.0]).pivoted(0.01);
        assert_eq!(pivoted.order, [0, 2, 1]);
        // some units in the last place
        assert!(pivoted.solve().iter().all(|x| (*x - re(1.0)).norm_sqr() < 1e-28), "{:?}", pivoted.solve());
    }

    /// Three columns of squares of two and products of one have singular values of the roots of 1, 1 and 4.
    #[test]
    fn the_condition_of_three_columns() {
        let found = of([[1.0, 1.0, 0.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]], [0.0; 3]).pivoted(0.01).condition();
        // some units in the last place
        assert!((found / 2.0 - 1.0).abs() < 1e-14, "{found}");
    }
}
