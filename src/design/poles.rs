//! Eigenvalues of a small matrix.
//!
//! The matrix less one is brought to Hessenberg form and then to triangular form by complex QR steps with Wilkinson's
//! shift [Golub and Van Loan, Matrix Computations, §7]. Taking one off keeps the digits of slow poles close to 1.

use super::Matrix;
use crate::math::{hypot, sqrt};

type Complex = (f64, f64);

const fn plus(a: Complex, b: Complex) -> Complex {
    (a.0 + b.0, a.1 + b.1)
}
const fn minus(a: Complex, b: Complex) -> Complex {
    (a.0 - b.0, a.1 - b.1)
}
const fn times(a: Complex, b: Complex) -> Complex {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}
const fn size(a: Complex) -> f64 {
    hypot(a.0, a.1)
}
const fn sum(a: Complex) -> f64 {
    a.0.abs() + a.1.abs()
}
/// The square root with a real part that is not negative.
const fn root(a: Complex) -> Complex {
    let r = size(a);
    if r == 0.0 {
        return (0.0, 0.0);
    }
    if a.0 >= 0.0 {
        let re = sqrt(0.5 * (r + a.0));
        (re, 0.5 * a.1 / re)
    } else {
        let im = sqrt(0.5 * (r - a.0));
        (0.5 * a.1.abs() / im, if a.1 < 0.0 { -im } else { im })
    }
}

/// Eigenvalues as pairs of real and imaginary part, in the order of falling real part; conjugates beside each other,
/// the negative imaginary part first. Not a number where the matrix is not finite.
#[must_use]
pub const fn eigenvalues<const N: usize>(a: &Matrix<N, N>) -> [Complex; N] {
    let mut h = hessenberg(&a.plus(-1.0, &Matrix::IDENTITY));
    let mut values = [(f64::NAN, f64::NAN); N];
    let mut last = N;
    let mut tries = 0;
    // The bounds beside the loops' own, here and below, hold anyway: they are there for the compiler, which then leaves
    // no panic in an image.
    while last > 0 && last <= N {
        let n = last - 1;
        // The block that is still joined to its last row.
        let mut low = n;
        while low > 0 && low < N {
            let (joint, above, here) = (h[low][low - 1], h[low - 1][low - 1], h[low][low]);
            // A size lies between 0.7 of the sum of its parts and that sum: roots are taken close to the edge alone.
            if 0.5 * sum(joint) <= f64::EPSILON * 0.1 * (sum(here) + sum(above)) || sum(joint) < 1e-289 {
                let around = size(here) + size(above);
                if size(joint) <= f64::EPSILON * 0.1 * around || size(joint) < 1e-290 {
                    h[low][low - 1] = (0.0, 0.0);
                    break;
                }
            }
            low -= 1;
        }
        if low >= n || n < 1 {
            values[n] = h[n][n];
            last -= 1;
            tries = 0;
            continue;
        }
        if tries > 200 || n >= N {
            return values;
        }
        let shift = if tries % 11 == 10 { (below(&h, n), below(&h, n)) } else { wilkinson(&h, n) };
        qr_step(&mut h, low, n, shift);
        tries += 1;
    }
    // A real matrix has real eigenvalues and conjugate pairs: remove rounding residues.
    each!(i, 0..N, {
        if values[i].1.abs() <= 1e-14 * size(values[i]) {
            values[i].1 = 0.0;
        }
        values[i].0 += 1.0;
        let mut j = i;
        while j > 0 && j < N && after(values[j - 1], values[j]) {
            values.swap(j - 1, j);
            j -= 1;
        }
    });
    values
}

/// Whether `a` comes after `b`.
const fn after(a: Complex, b: Complex) -> bool {
    if (a.0 - b.0).abs() > 1e-12 { a.0 < b.0 } else { a.1 > b.1 }
}

/// Largest size of a set of poles; not a number where one is not.
#[must_use]
pub const fn spectral_radius(poles: &[Complex]) -> f64 {
    let mut largest = 0.0;
    each!(i, 0..poles.len(), {
        let size = size(poles[i]);
        if size.is_nan() {
            return size;
        }
        if size > largest {
            largest = size;
        }
    });
    largest
}

/// Hessenberg form by elimination with exchanges, as complex numbers.
const fn hessenberg<const N: usize>(a: &Matrix<N, N>) -> [[Complex; N]; N] {
    let mut a = *a;
    each!(column, 0.., column + 2 < N, {
        let pivot = column + 1;
        let mut best = pivot;
        each!(i, (pivot + 1)..N, {
            if a.0[i][column].abs() > a.0[best][column].abs() {
                best = i;
            }
        });
        a.0.swap(pivot, best);
        each!(r, 0..N, {
            a.0[r].swap(pivot, best);
        });
        each!(i, (pivot + 1).., i < N && a.0[pivot][column] != 0.0, {
            let factor = a.0[i][column] / a.0[pivot][column];
            each!(j, 0..N, {
                a.0[i][j] -= factor * a.0[pivot][j];
            });
            each!(r, 0..N, {
                a.0[r][pivot] += factor * a.0[r][i];
            });
        });
    });
    let mut h = [[(0.0, 0.0); N]; N];
    each!(i, 0..N, {
        each!(j, 0..N, {
            if j + 1 >= i {
                h[i][j].0 = a.0[i][j];
            }
        });
    });
    h
}

/// Size of the element left of a row's diagonal.
const fn below<const N: usize>(h: &[[Complex; N]; N], n: usize) -> f64 {
    if n < 1 || n >= N { 0.0 } else { size(h[n][n - 1]) }
}

/// The eigenvalue of the last two rows' block that is nearer to its last element.
const fn wilkinson<const N: usize>(h: &[[Complex; N]; N], n: usize) -> Complex {
    if n < 1 || n >= N {
        return (0.0, 0.0);
    }
    let (a, b, c, d) = (h[n - 1][n - 1], h[n - 1][n], h[n][n - 1], h[n][n]);
    let half = minus(a, d);
    let half = (0.5 * half.0, 0.5 * half.1);
    let r = root(plus(times(half, half), times(b, c)));
    let one = plus(plus(d, half), r);
    let two = minus(plus(d, half), r);
    if size(minus(one, d)) < size(minus(two, d)) { one } else { two }
}

/// One QR step with Givens rotations on the rows and columns `low..=n`.
const fn qr_step<const N: usize>(h: &mut [[Complex; N]; N], low: usize, n: usize, shift: Complex) {
    let mut turns = [((1.0, 0.0), (0.0, 0.0)); N];
    each!(i, low.., i <= n && i < N, {
        h[i][i] = minus(h[i][i], shift);
    });
    each!(i, low.., i < n && i + 1 < N, {
        let (x, y) = (h[i][i], h[i + 1][i]);
        let length = hypot(size(x), size(y));
        if length > 0.0 {
            turns[i] = ((x.0 / length, x.1 / length), (y.0 / length, y.1 / length));
        }
        // Without the functions of complex numbers: a call costs the compiler, which interprets this, the most.
        let ((c, d), (s, t)) = turns[i];
        each!(j, i.., j <= n && j < N, {
            let ((p, q), (u, v)) = (h[i][j], h[i + 1][j]);
            h[i][j] = ((c * p + d * q) + (s * u + t * v), (c * q - d * p) + (s * v - t * u));
            h[i + 1][j] = ((c * u - d * v) - (s * p - t * q), (c * v + d * u) - (s * q + t * p));
        });
    });
    each!(i, low.., i < n && i + 1 < N, {
        let ((c, d), (s, t)) = turns[i];
        each!(r, low.., r <= n && r <= i + 1 && r < N, {
            let ((p, q), (u, v)) = (h[r][i], h[r][i + 1]);
            h[r][i] = ((p * c - q * d) + (u * s - v * t), (p * d + q * c) + (u * t + v * s));
            h[r][i + 1] = ((u * c + v * d) - (p * s + q * t), (v * c - u * d) - (q * s - p * t));
        });
    });
    each!(i, low.., i <= n && i < N, {
        h[i][i] = plus(h[i][i], shift);
    });
}
