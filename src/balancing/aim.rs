//! The rule by which weights are chosen: objective, weighting, limits.

use super::scalar::{Complex, Scalar, real};

/// The norm of the residual to minimise.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Objective {
    /// The sum of the squares (Goodman 1964).
    #[default]
    LeastSquares,
    /// The largest amplitude.
    MinMax,
}

/// How weights are chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
// Not logged: the complex numbers of `nalgebra` have no `Format`.
pub struct Aim<T: Scalar, const ROWS: usize, const PLANES: usize> {
    /// The norm to minimise.
    pub objective: Objective,
    /// Weighting of each residual: positive, or zero for a reading that is left out.
    pub weighting: [T; ROWS],
    /// The largest weight of each plane, if there is a limit.
    pub limits: [Option<T>; PLANES],
    /// Smallest share of a plane's effect that must be independent of the other planes for the plane to be used.
    ///
    /// With readings accurate to 1 %, a plane with a smaller independent share cannot be separated from the others.
    pub independence: T,
}

impl<T: Scalar, const ROWS: usize, const PLANES: usize> Default for Aim<T, ROWS, PLANES> {
    /// Least squares, all readings alike, no limits, 1 % of independence.
    fn default() -> Self {
        Aim {
            objective: Objective::LeastSquares,
            weighting: [T::one(); ROWS],
            limits: [None; PLANES],
            independence: real(0.01),
        }
    }
}

impl<T: Scalar, const ROWS: usize, const PLANES: usize> Aim<T, ROWS, PLANES> {
    /// The readings among the first `rows` that are not weighted with zero.
    pub(crate) fn counted<'r>(
        &'r self,
        readings: &'r [Complex<T>; ROWS],
        rows: usize,
    ) -> impl Iterator<Item = Complex<T>> + 'r {
        let weighted = readings.iter().zip(&self.weighting).take(rows);
        weighted.filter(|(_, weighting)| **weighting > T::zero()).map(|(reading, _)| *reading)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Neither the second reading, weighted with zero, nor the fourth, which is not in use.
    #[test]
    fn readings_weighted_with_zero_do_not_count() {
        let aim = Aim::<f64, 4, 1> { weighting: [0.5, 0.0, 2.0, 1.0], ..Aim::default() };
        let readings = [1.0, 2.0, 3.0, 4.0].map(|re| Complex { re, im: 0.0 });
        assert!(aim.counted(&readings, 3).eq([readings[0], readings[2]]));
    }
}
