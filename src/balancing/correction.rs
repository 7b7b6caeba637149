//! Weights from influence coefficients: least squares, weighted, min-max, within limits.

use heapless::Vec;
use nalgebra::ComplexField;

use super::aim::{Aim, Objective};
use super::error::Error;
use super::influence::Influence;
use super::matrix::pick;
use super::min_max::Search;
use super::qr::Qr;
use super::scalar::{Complex, Scalar, real, size, square, zero};

/// A plane that is not used, and why.
#[derive(Clone, Copy, Debug, PartialEq)]
// Not logged: the complex numbers of `nalgebra` have no `Format`.
pub struct LeftOut<T: Scalar, const PLANES: usize> {
    /// The plane.
    pub plane: usize,
    /// The share of its effect that no combination of the used planes has, 0 to 1.
    pub own: T,
    /// A weight of one in this plane does the same as these weights in the used planes, but for that share.
    pub like: [Complex<T>; PLANES],
}

/// Correction weights and the predicted residual.
///
/// ```
/// use driveline::balancing::{Aim, Complex, Influence};
/// // 0.3i um per gram, 4 um to take away: -4/0.3i = 13.3 g at 90 degrees
/// let mut fan = Influence::<f64, 1, 1>::new(1, 1)?;
/// fan.set(0, &[Complex::new(0.0, 0.3)])?;
/// let correction = fan.correct(&[Complex::new(4.0, 0.0)], &Aim::default())?;
/// assert!((correction.weights[0] - Complex::new(0.0, 40.0 / 3.0)).norm() < 1e-12 && correction.largest < 1e-12);
/// # Ok::<(), driveline::balancing::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
// Not logged: the complex numbers of `nalgebra` have no `Format`.
pub struct Correction<T: Scalar, const ROWS: usize, const PLANES: usize> {
    /// The weight of each plane; zero in planes that are left out.
    pub weights: [Complex<T>; PLANES],
    /// The readings with them, as predicted.
    pub residual: [Complex<T>; ROWS],
    /// Root mean square of the residual's amplitudes, those of readings that are weighted with zero left out.
    pub rms: T,
    /// The largest of them, likewise.
    pub largest: T,
    /// Greatest over least singular value of the used planes' influence: how many times larger than a reading's error
    /// that of a weight may be.
    pub condition: T,
    /// Planes that are not used.
    pub left_out: Vec<LeftOut<T, PLANES>, PLANES>,
    /// For a search (min-max, or active limits): the lower bound of the objective by duality, and its value; each the
    /// root of the sum of squares, or the largest amplitude, weighted.
    pub bounds: Option<(T, T)>,
}

impl<T: Scalar, const ROWS: usize, const PLANES: usize> Influence<T, ROWS, PLANES> {
    /// The weights that minimise the residual vibration `A w + v`.
    ///
    /// # Errors
    /// A missing or invalid entry; [`Error::NotProven`] where the optimum could not be proven.
    pub fn correct(
        &self,
        vibration: &[Complex<T>],
        aim: &Aim<T, ROWS, PLANES>,
    ) -> Result<Correction<T, ROWS, PLANES>, Error> {
        self.complete(vibration)?;
        if let Some(plane) = self.unknown() {
            return Err(Error::PlaneUnknown { plane });
        }
        // written so that a NaN is none of them
        let weighted = |value: &T| *value >= T::zero() && value.is_finite();
        if let Some(index) = aim.weighting.iter().take(self.rows()).position(|value| !weighted(value)) {
            return Err(Error::Setting { index });
        }
        let limited = |value: &Option<T>| value.is_none_or(|value| value > T::zero() && value.is_finite());
        if let Some(index) = aim.limits.iter().take(self.planes()).position(|value| !limited(value)) {
            return Err(Error::Setting { index });
        }
        let used = aim.weighting.iter().take(self.rows()).filter(|value| **value > T::zero()).count();
        if used < self.planes() {
            return Err(Error::MorePlanesThanReadings { planes: self.planes(), readings: used });
        }

        let qr = self.qr(vibration, &aim.weighting);
        let pivoted = qr.pivoted(aim.independence);
        let mut weights = pivoted.solve();
        let mut bounds = None;
        let plain = self.amplitude(vibration, &weights, aim);
        let none = self.amplitude(vibration, &[zero(); PLANES], aim);
        let beyond =
            weights.iter().zip(&aim.limits).any(|(weight, limit)| limit.is_some_and(|limit| size(*weight) > limit));
        // where nothing is left there is nothing to search for
        let nothing = plain.1 <= none.1 * T::default_epsilon() * real(4.0);
        if beyond || aim.objective == Objective::MinMax && !nothing {
            let found = Search::new(self, vibration, aim, &pivoted).run(&weights);
            weights = found.weights;
            let (squares, largest) = self.amplitude(vibration, &weights, aim);
            let reached = if aim.objective == Objective::MinMax { largest } else { squares.sqrt() };
            let rounding = self.rounding(vibration, &weights, aim);
            let below = (found.below - rounding).max(T::zero()).min(reached);
            // ten thousand times the aim in double precision, a hundred times in single: the accuracy promised to the
            // caller; none is promised within the rounding of the sum of weights and vibration
            let promised = reached * real::<T>(T::CLOSE).max(real(1e-8)) * real(100.0);
            if !(reached - below <= promised.max(rounding * real(4.0))) {
                return Err(Error::NotProven);
            }
            bounds = Some((below, reached));
        }
        let residual = self.predict(vibration, &weights)?;
        let mut left_out = Vec::new();
        for j in pivoted.rank..PLANES {
            let plane = pick(&pivoted.order, j, PLANES);
            if plane < self.planes() {
                let (own, like) = pivoted.combination(j);
                // there is room for each plane
                let _ = left_out.push(LeftOut { plane, own, like });
            }
        }
        let counted = || aim.counted(&residual, self.rows());
        let squares = counted().fold(T::zero(), |sum, value| sum + square(value));
        let largest = counted().fold(T::zero(), |largest, value| largest.max(size(value)));
        let rms = (squares / real(used as f64)).sqrt();
        Ok(Correction { weights, residual, rms, largest, condition: pivoted.condition(), left_out, bounds })
    }

    /// The rows `weighting (A w) = -weighting v`.
    pub(crate) fn qr(&self, vibration: &[Complex<T>], weighting: &[T; ROWS]) -> Qr<T, PLANES> {
        let mut qr = Qr::new();
        for row in 0..self.rows() {
            let (a, b) = self.row(row, vibration, weighting);
            qr.absorb(&a, -b);
        }
        qr
    }

    /// A weighted row and its weighted vibration.
    pub(crate) fn row(
        &self,
        row: usize,
        vibration: &[Complex<T>],
        weighting: &[T; ROWS],
    ) -> ([Complex<T>; PLANES], Complex<T>) {
        let mut a = [zero(); PLANES];
        for (plane, value) in a.iter_mut().enumerate().take(self.planes()) {
            *value = self.coefficients.at(row, plane).scale(pick(weighting, row, T::zero()));
        }
        (a, pick(vibration, row, zero()).scale(pick(weighting, row, T::zero())))
    }

    /// The weighted residual, zeros behind the last row.
    pub(crate) fn weighted(
        &self,
        vibration: &[Complex<T>],
        weights: &[Complex<T>; PLANES],
        weighting: &[T; ROWS],
    ) -> [Complex<T>; ROWS] {
        let mut residual = [zero(); ROWS];
        for (row, value) in residual.iter_mut().enumerate().take(self.rows()) {
            let (a, b) = self.row(row, vibration, weighting);
            *value = a.iter().zip(weights).fold(b, |sum, (a, w)| sum + *a * *w);
        }
        residual
    }

    /// Sum of squares and largest amplitude of the weighted residual.
    fn amplitude(
        &self,
        vibration: &[Complex<T>],
        weights: &[Complex<T>; PLANES],
        aim: &Aim<T, ROWS, PLANES>,
    ) -> (T, T) {
        self.weighted(vibration, weights, &aim.weighting)
            .iter()
            .fold((T::zero(), T::zero()), |(squares, largest), value| {
                (squares + square(*value), largest.max(size(*value)))
            })
    }

    /// What rounding of the weights and of the sums can make of the weighted residual.
    fn rounding(&self, vibration: &[Complex<T>], weights: &[Complex<T>; PLANES], aim: &Aim<T, ROWS, PLANES>) -> T {
        let mut largest = T::zero();
        for row in 0..self.rows() {
            let (a, b) = self.row(row, vibration, &aim.weighting);
            largest = largest.max(a.iter().zip(weights).fold(size(b), |sum, (a, w)| sum + size(*a) * size(*w)));
        }
        let sums = if aim.objective == Objective::MinMax { T::one() } else { real::<T>(self.rows() as f64).sqrt() };
        largest * sums * T::default_epsilon() * real((PLANES + 2) as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn re(re: f64) -> Complex<f64> {
        Complex { re, im: 0.0 }
    }

    /// Of one reading and one plane.
    fn one(coefficient: f64) -> Influence<f64, 1, 1> {
        let mut influence = Influence::new(1, 1).unwrap();
        influence.set(0, &[re(coefficient)]).unwrap();
        influence
    }

    /// Each error is beside its row: magnitudes summed, by the epsilon and the number of operations, three planes and
    /// two more; over the rows by the root of their number.
    #[test]
    fn rounding_is_bounded_by_the_sums() {
        let mut influence = Influence::<f64, 3, 3>::new(2, 2).unwrap();
        influence.set(0, &[re(2.0), re(1.0)]).unwrap();
        influence.set(1, &[re(-3.0), re(1.0)]).unwrap();
        for (objective, sums) in [(Objective::MinMax, 1.0), (Objective::LeastSquares, f64::sqrt(2.0))] {
            let aim = Aim { objective, ..Aim::default() };
            let found = influence.rounding(&[re(1.0), re(2.0)], &[re(4.0), re(-5.0), re(0.0)], &aim);
            // 1 + 2 4 + 3 5, which is more than 2 + 4 + 5
            let expected = 24.0 * sums * f64::EPSILON * 5.0;
            assert!((found / expected - 1.0).abs() < 1e-14, "{found} {expected}");
        }
    }

    /// Weights at their limit, and a solution that leaves no more than rounding, are not searched for.
    #[test]
    fn nothing_is_searched_for_without_need() {
        let bounds = |coefficient: f64, vibration: f64, aim: Aim<f64, 1, 1>| {
            one(coefficient).correct(&[re(vibration)], &aim).unwrap().bounds.is_some()
        };
        let limited = |limit: f64| Aim { limits: [Some(limit)], ..Aim::default() };
        assert!(!bounds(1.0, -2.0, limited(2.0)) && bounds(1.0, -2.0, limited(1.9)));
        let min_max = Aim { objective: Objective::MinMax, ..Aim::default() };
        // quotients and products of three tenths that leave some 1e-17 or nothing
        for coefficient in [0.1, 0.3, 0.7, 1.1, 1.3, 2.3, 4.9] {
            for vibration in [0.1, 0.3, 0.7, 0.9, 1.7, 3.1, 5.3] {
                assert!(!bounds(coefficient, vibration, min_max), "{coefficient} {vibration}");
            }
        }
    }

    /// In double precision 49 times 1/49 is 1 less half a unit in the last place.
    #[test]
    fn rounding_is_nothing_to_search_for() {
        let aim = Aim { objective: Objective::MinMax, ..Aim::default() };
        let found = one(49.0).correct(&[re(1.0)], &aim).unwrap();
        assert_eq!((found.largest, found.bounds), (f64::EPSILON / 2.0, None));
    }

    /// The bound stays below the objective by what rounding can make of a sum of 1 and 2 times 1/2: three units in the
    /// last place of it for one plane. Readings of 1 and 2^-27 on either side are least where 2^-27 is left of both.
    #[test]
    fn the_bound_allows_for_rounding() {
        let left = 1.0 / 134_217_728.0;
        let mut influence = Influence::<f64, 2, 1>::new(2, 1).unwrap();
        influence.set(0, &[re(2.0); 2]).unwrap();
        let aim = Aim { objective: Objective::MinMax, ..Aim::default() };
        let (below, reached) = influence.correct(&[re(1.0 + left), re(1.0 - left)], &aim).unwrap().bounds.unwrap();
        let rounding = 2.0 * 3.0 * f64::EPSILON;
        // the search ends at 1e-10 of the optimum, less than a thousandth of the rounding
        assert!(((reached - below) / rounding - 1.0).abs() < 2e-3, "{:e} {rounding:e}", reached - below);
    }

    /// The square of a limit of 1e-200 is zero in double precision: no search can be within it, and nothing is proven.
    #[test]
    fn what_is_not_proven_is_not_given() {
        let aim = Aim { limits: [Some(1e-200)], ..Aim::default() };
        assert_eq!(one(1.0).correct(&[re(1.0)], &aim), Err(Error::NotProven));
    }
}
