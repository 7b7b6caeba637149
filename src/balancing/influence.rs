//! Influence coefficients: the change of each reading per unit weight in each plane.

use super::error::Error;
use super::matrix::{Matrix, pick};
use super::scalar::{Complex, Scalar, given, real, size, square, zero};

/// Influence coefficients of at most `PLANES` planes on at most `ROWS` readings
/// (unit of the reading per unit of the weight).
///
/// A row is a sensor at a speed; the order is the user's, and the same in all runs.
///
/// `v = A w + v0` [Goodman 1964]: a row for each sensor at each speed, a column for each plane. A trial weight gives a
/// column, `a = (v - v0) / w`.
///
/// ```
/// use driveline::balancing::{Complex, Influence};
/// // 4 um before, 4 + 3i um with 10 g: the plane gives 0.3 um per gram, a quarter of a turn ahead
/// let [before, with] = [Complex::new(4.0, 0.0), Complex::new(4.0, 3.0)];
/// let mut fan = Influence::<f64, 1, 1>::new(1, 1)?;
/// fan.learn(0, &[before], &[with], Complex::new(10.0, 0.0))?;
/// assert_eq!(fan.get(0, 0), Some(Complex::new(0.0, 0.3)));
/// # Ok::<(), driveline::balancing::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
// Not logged: the complex numbers of `nalgebra` have no `Format`.
pub struct Influence<T: Scalar, const ROWS: usize, const PLANES: usize> {
    rows: usize,
    planes: usize,
    pub(crate) coefficients: Matrix<T, ROWS, PLANES>,
    known: [bool; PLANES],
}

impl<T: Scalar, const ROWS: usize, const PLANES: usize> Influence<T, ROWS, PLANES> {
    /// Nothing known yet of `planes` planes and `rows` readings. A type with room for more planes than readings does
    /// not compile.
    ///
    /// # Errors
    /// [`Error::Size`], [`Error::MorePlanesThanReadings`].
    pub fn new(rows: usize, planes: usize) -> Result<Self, Error> {
        const { assert!(PLANES <= ROWS, "{}", Error::MORE_PLANES_THAN_READINGS) };
        if rows == 0 || planes == 0 || rows > ROWS || planes > PLANES {
            return Err(Error::Size);
        }
        if planes > rows {
            return Err(Error::MorePlanesThanReadings { planes, readings: rows });
        }
        Ok(Influence { rows, planes, coefficients: Matrix::new(), known: [false; PLANES] })
    }

    /// Readings of a run.
    pub const fn rows(&self) -> usize {
        self.rows
    }

    /// Correction planes.
    pub const fn planes(&self) -> usize {
        self.planes
    }

    /// The coefficient of a plane on a reading; `None` where it is not known.
    pub fn get(&self, row: usize, plane: usize) -> Option<Complex<T>> {
        let known = row < self.rows && self.known.get(plane).copied().unwrap_or(false);
        if known { Some(self.coefficients.at(row, plane)) } else { None }
    }

    /// The first plane whose coefficients are not known.
    pub fn unknown(&self) -> Option<usize> {
        self.known.iter().take(self.planes).position(|known| !known)
    }

    /// Sets a plane's coefficients, from a model or from the rotor before.
    ///
    /// # Errors
    /// [`Error::NoPlane`], [`Error::ReadingMissing`], [`Error::Reading`].
    pub fn set(&mut self, plane: usize, column: &[Complex<T>]) -> Result<(), Error> {
        if plane >= self.planes {
            return Err(Error::NoPlane { plane });
        }
        self.complete(column)?;
        for (row, value) in column.iter().enumerate().take(self.rows) {
            self.coefficients.set(row, plane, *value);
        }
        if let Some(known) = self.known.get_mut(plane) {
            *known = true;
        }
        Ok(())
    }

    /// Learns a plane from a trial run: the readings before, the readings with the trial weight, and the weight.
    ///
    /// Where trial weights are taken off again, `before` is the baseline; where they stay, the run before this one.
    ///
    /// # Errors
    /// An invalid weight or reading; the coefficients stay.
    pub fn learn(
        &mut self,
        plane: usize,
        before: &[Complex<T>],
        with: &[Complex<T>],
        trial: Complex<T>,
    ) -> Result<(), Error> {
        self.learn_further(plane, before, with, trial, T::zero()).map(|_| ())
    }

    /// Learns a plane from a further trial run, by least squares over all of them:
    /// `a = sum conj(w) (v - v0) / sum |w|^2`.
    ///
    /// `known` is the value that the last call for this plane returned, zero for the first: the sum of the squares of
    /// its trial weights.
    ///
    /// # Errors
    /// An invalid weight or reading; the coefficients stay.
    pub fn learn_further(
        &mut self,
        plane: usize,
        before: &[Complex<T>],
        with: &[Complex<T>],
        trial: Complex<T>,
        known: T,
    ) -> Result<T, Error> {
        if plane >= self.planes {
            return Err(Error::NoPlane { plane });
        }
        if !given(trial) {
            return Err(Error::Weight { plane });
        }
        if !(size(trial) > T::zero()) {
            return Err(Error::TrialWeightZero { plane });
        }
        self.complete(before)?;
        self.complete(with)?;
        let mut column = [zero(); ROWS];
        let (mut largest, mut change) = (T::zero(), T::zero());
        let all = known + square(trial);
        for (row, ((value, with), before)) in column.iter_mut().zip(with).zip(before).take(self.rows).enumerate() {
            let alone = (*with - *before) / trial;
            let so_far = self.coefficients.at(row, plane);
            *value = if known > T::zero() { so_far + (alone - so_far).scale(square(trial) / all) } else { alone };
            change = change.max(size(*with - *before));
            largest = largest.max(size(*before));
        }
        // less than rounding makes of equal readings is no effect
        if !(change > largest * T::default_epsilon() * real(4.0)) {
            return Err(Error::NoEffect { plane });
        }
        self.set(plane, &column)?;
        Ok(all)
    }

    /// Readings with these weights in the planes: `A w + v`, zeros behind the last row.
    ///
    /// # Errors
    /// A reading that is missing or no number.
    pub fn predict(&self, vibration: &[Complex<T>], weights: &[Complex<T>]) -> Result<[Complex<T>; ROWS], Error> {
        self.complete(vibration)?;
        let mut predicted = [zero(); ROWS];
        for (row, value) in predicted.iter_mut().enumerate().take(self.rows) {
            *value = pick(vibration, row, zero());
            for (plane, weight) in weights.iter().enumerate().take(self.planes) {
                *value += self.coefficients.at(row, plane) * *weight;
            }
        }
        Ok(predicted)
    }

    /// Whether there is a reading for each row, and each a number.
    pub(crate) fn complete(&self, readings: &[Complex<T>]) -> Result<(), Error> {
        if readings.len() < self.rows {
            return Err(Error::ReadingMissing { row: readings.len() });
        }
        match readings.iter().take(self.rows).position(|reading| !given(*reading)) {
            Some(row) => Err(Error::Reading { row }),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn re(re: f64) -> Complex<f64> {
        Complex { re, im: 0.0 }
    }

    /// A first trial run replaces what was set, with nothing of its size left: (3 - 1)/1 is exact.
    #[test]
    fn a_first_trial_run_counts_alone() {
        let mut influence = Influence::<f64, 1, 1>::new(1, 1).unwrap();
        influence.set(0, &[re(1e20)]).unwrap();
        assert_eq!(influence.learn_further(0, &[re(1.0)], &[re(3.0)], re(1.0), 0.0), Ok(1.0));
        assert_eq!(influence.get(0, 0), Some(re(2.0)));
    }

    /// Readings that are the same are no effect, and so are four units in the last place; more are one.
    #[test]
    fn equal_readings_are_no_effect() {
        let mut influence = Influence::<f64, 1, 1>::new(1, 1).unwrap();
        let refused = Err(Error::NoEffect { plane: 0 });
        assert_eq!(influence.learn(0, &[re(0.0)], &[re(0.0)], re(1.0)), refused);
        assert_eq!(influence.learn(0, &[re(1.0)], &[re(1.0 + 4.0 * f64::EPSILON)], re(1.0)), refused);
        assert_eq!(influence.learn(0, &[re(1.0)], &[re(1.0 + 5.0 * f64::EPSILON)], re(1.0)), Ok(()));
        assert_eq!(influence.get(0, 0), Some(re(5.0 * f64::EPSILON)));
    }
}
