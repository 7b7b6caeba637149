//! Steady-state gains of a Kalman filter.

use super::exponential::balance;
use super::{Error, Matrix, doubling, eigenvalues};
use crate::math::sqrt;

/// A steady-state filter for `x+ = F x + B u + w`, `y = H x + e`, `E[w w^T] = Q`, `E[e e^T] = R`.
///
/// ```
/// use driveline::design::{Kalman, Matrix};
/// // a random walk of variance 1 a tick, measured with variance 1: P = (1 + sqrt(5))/2, K = P/(P + 1)
/// const ONE: Matrix<1, 1> = Matrix([[1.0]]);
/// let filter = Kalman::design(&ONE, &ONE, &ONE, &ONE)?;
/// let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
/// assert!((filter.prior.0[0][0] - golden).abs() < 1e-9 && (filter.gain.0[0][0] - 1.0 / golden).abs() < 1e-9);
/// # Ok::<(), driveline::design::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Kalman<const N: usize, const M: usize> {
    /// Filter gain `K = P H^T S^-1`: the correction at the tick of the measurement.
    pub gain: Matrix<N, M>,
    /// Covariance of the error before the measurement, `P = F P F^T + Q - F K H P F^T`.
    pub prior: Matrix<N, N>,
    /// Covariance of the error after the measurement, `(1 - K H) P`.
    pub posterior: Matrix<N, N>,
    /// Covariance of the innovation, `S = H P H^T + R`.
    pub innovation: Matrix<M, M>,
    /// Poles of the estimate's error, the eigenvalues of `(1 - K H) F`, as pairs of real and imaginary part.
    pub poles: [(f64, f64); N],
    /// Largest size of a pole; below 1.
    pub spectral_radius: f64,
}

impl<const N: usize, const M: usize> Kalman<N, M> {
    /// Designs the gains.
    ///
    /// The states may have very different units: the equation is solved in the units that make F balanced.
    ///
    /// # Errors
    /// [`Error::Noise`] where R is not invertible or not positive on its diagonal. [`Error::NotConverged`] where there
    /// is no stabilising solution. [`Error::NotStabilising`] where the gain leaves a pole on or outside the unit
    /// circle.
    pub const fn design(f: &Matrix<N, N>, h: &Matrix<M, N>, q: &Matrix<N, N>, r: &Matrix<M, M>) -> Result<Self, Error> {
        each!(j, 0..M, {
            if !(r.0[j][j] > 0.0 && r.0[j][j].is_finite()) {
                return Err(Error::Noise);
            }
        });
        let mut units = balance(f);
        let prior = get!(solve(f, h, q, r, &units));
        each!(i, 0..N, {
            if prior.0[i][i] > 0.0 {
                units[i] = power_of_two(sqrt(prior.0[i][i]));
            }
        });

        let seen = h.times(&prior);
        let innovation = seen.times(&h.transpose()).plus(1.0, r).symmetric();
        let Some(gain) = innovation.solve(&seen) else {
            return Err(Error::Noise);
        };
        let gain = gain.transpose();
        let left = Matrix::IDENTITY.plus(-1.0, &gain.times(h));
        // Joseph's form: no cancellation, positive by construction.
        let posterior =
            left.times(&prior).times(&left.transpose()).plus(1.0, &gain.times(r).times(&gain.transpose())).symmetric();
        let poles = eigenvalues(&left.times(f).scaled(&inverse(&units), &inverse(&units)));
        let spectral_radius = super::spectral_radius(&poles);
        if spectral_radius.is_nan() || spectral_radius >= 1.0 {
            return Err(Error::NotStabilising);
        }
        Ok(Self { gain, prior, posterior, innovation, poles, spectral_radius })
    }
}

/// The prior covariance, solved with every state in its own unit.
const fn solve<const N: usize, const M: usize>(
    f: &Matrix<N, N>,
    h: &Matrix<M, N>,
    q: &Matrix<N, N>,
    r: &Matrix<M, M>,
    units: &[f64; N],
) -> Result<Matrix<N, N>, Error> {
    let per = inverse(units);
    let f = f.scaled(&per, &per);
    let h = h.scaled(&[1.0; M], &per);
    let q = q.scaled(&per, units);
    let Some(weighted) = r.solve(&h) else {
        return Err(Error::Noise);
    };
    let information = h.transpose().times(&weighted).symmetric();
    match doubling(&f.transpose(), &information, &q) {
        Some(found) => Ok(found.scaled(units, &per)),
        None => Err(Error::NotConverged),
    }
}

/// The power of two just below a positive number: a unit that rounds nothing.
const fn power_of_two(x: f64) -> f64 {
    f64::from_bits(x.to_bits() & (0x7FF << 52))
}

const fn inverse<const N: usize>(units: &[f64; N]) -> [f64; N] {
    let mut other = *units;
    each!(i, 0..N, {
        other[i] = 1.0 / other[i];
    });
    other
}
