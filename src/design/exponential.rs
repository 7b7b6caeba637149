//! The matrix exponential, by balancing, scaling and squaring with the Padé approximant of degree 13.

use super::Matrix;
use crate::math::scale_by_power_of_two;

/// Coefficients of the Padé approximant [Higham 2005, SIAM J. Matrix Anal. Appl. 26(4)].
const PADE: [f64; 14] = [
    64_764_752_532_480_000.0,
    32_382_376_266_240_000.0,
    7_771_770_303_897_600.0,
    1_187_353_796_428_800.0,
    129_060_195_264_000.0,
    10_559_470_521_600.0,
    670_442_572_800.0,
    33_522_128_640.0,
    1_323_241_920.0,
    40_840_800.0,
    960_960.0,
    16_380.0,
    182.0,
    1.0,
];

/// `e^A`, or `None` where an element of `A` is not finite or its norm is above 1e15.
///
/// The unit matrix is taken off before squaring, so that small steps keep their digits. States of very different
/// units do no harm: the matrix is first balanced by powers of two. The error is that of rounding times the number of
/// radians that the fastest mode turns.
#[must_use]
pub const fn exponential<const N: usize>(a: &Matrix<N, N>) -> Option<Matrix<N, N>> {
    let units = balance(a);
    let balanced = a.scaled(&reciprocal(&units), &reciprocal(&units));
    let norm = balanced.norm();
    if norm.is_nan() || norm > 1e15 {
        return None;
    }
    let mut squarings = 0;
    let mut reach = 2.0;
    while norm > reach {
        reach *= 2.0;
        squarings += 1;
    }
    let small = Matrix::ZERO.plus(scale_by_power_of_two(1.0, -squarings), &balanced);

    let a2 = small.times(&small);
    let a4 = a2.times(&a2);
    let a6 = a4.times(&a2);
    let odd = a6.times(&sum(&a6, &a4, &a2, PADE[13], PADE[11], PADE[9], 0.0));
    let odd = small.times(&odd.plus(1.0, &sum(&a6, &a4, &a2, PADE[7], PADE[5], PADE[3], PADE[1])));
    let even = a6.times(&sum(&a6, &a4, &a2, PADE[12], PADE[10], PADE[8], 0.0));
    let even = even.plus(1.0, &sum(&a6, &a4, &a2, PADE[6], PADE[4], PADE[2], PADE[0]));

    // (even - odd) (e^A - 1) = 2 odd
    let Some(mut less_one) = even.plus(-1.0, &odd).solve(&Matrix::ZERO.plus(2.0, &odd)) else {
        return None;
    };
    while squarings > 0 {
        less_one = Matrix::ZERO.plus(2.0, &less_one).plus(1.0, &less_one.times(&less_one));
        squarings -= 1;
    }
    Some(Matrix::IDENTITY.plus(1.0, &less_one).scaled(&units, &units))
}

/// Exact zero-order-hold matrices `(F, G)` of `x' = A x + B u` over a period (s), `None` as for [`exponential`].
///
/// `W` must be `N + M`: the order of the matrix that joins states and inputs.
#[must_use]
pub const fn discretise<const N: usize, const M: usize, const W: usize>(
    a: &Matrix<N, N>,
    b: &Matrix<N, M>,
    period: f64,
) -> Option<(Matrix<N, N>, Matrix<N, M>)> {
    const { assert!(W == N + M, "the joined order must be the number of states and inputs") };
    let mut joined = Matrix::<W, W>::ZERO;
    each!(i, 0..N, {
        each!(j, 0..W, {
            joined.0[i][j] = if j < N { a.0[i][j] } else { b.0[i][j - N] } * period;
        });
    });
    let Some(whole) = exponential(&joined) else {
        return None;
    };
    let mut f = Matrix::ZERO;
    let mut g = Matrix::ZERO;
    each!(i, 0..N, {
        each!(j, 0..W, {
            if j < N {
                f.0[i][j] = whole.0[i][j];
            } else {
                g.0[i][j - N] = whole.0[i][j];
            }
        });
    });
    Some((f, g))
}

/// `c6 a6 + c4 a4 + c2 a2 + c0`.
const fn sum<const N: usize>(
    a6: &Matrix<N, N>,
    a4: &Matrix<N, N>,
    a2: &Matrix<N, N>,
    c6: f64,
    c4: f64,
    c2: f64,
    c0: f64,
) -> Matrix<N, N> {
    Matrix::ZERO.plus(c0, &Matrix::IDENTITY).plus(c2, a2).plus(c4, a4).plus(c6, a6)
}

const fn reciprocal<const N: usize>(units: &[f64; N]) -> [f64; N] {
    let mut other = *units;
    each!(i, 0..N, {
        other[i] = 1.0 / other[i];
    });
    other
}

/// Powers of two `d` for which `a[i][j] d[j]/d[i]` has rows and columns of like size [Parlett and Reinsch 1969].
pub(super) const fn balance<const N: usize>(a: &Matrix<N, N>) -> [f64; N] {
    let mut units = [1.0; N];
    let mut round = 0;
    let mut changed = true;
    while changed && round < 100 {
        changed = false;
        each!(i, 0..N, {
            let (mut row, mut column) = (0.0, 0.0);
            each!(j, 0..N, {
                if j != i {
                    row += (a.0[i][j] * units[j] / units[i]).abs();
                    column += (a.0[j][i] * units[i] / units[j]).abs();
                }
            });
            if row > 0.0 && column > 0.0 && row.is_finite() && column.is_finite() {
                let before = row + column;
                let mut factor = 1.0;
                while column * factor * 2.0 < row / factor {
                    factor *= 2.0;
                }
                while column * factor > 2.0 * row / factor {
                    factor *= 0.5;
                }
                if column * factor + row / factor < 0.95 * before {
                    units[i] *= factor;
                    changed = true;
                }
            }
        });
        round += 1;
    }
    units
}
