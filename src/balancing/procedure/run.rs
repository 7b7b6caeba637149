//! A run: readings, and the speed of each.

use crate::balancing::error::Error;
use crate::balancing::scalar::{Complex, Scalar, given, zero};

/// A run: a reading for each row, and the speed it was taken at.
///
/// ```
/// use driveline::balancing::{Complex, Error, Run};
/// // two sensors at 155 rad/s; a reading that was left out is found by its row
/// let front = Complex::from_polar(4e-6, 30.0_f64.to_radians());
/// assert!(Run::<f64, 2>::new(&[front, front], &[155.0; 2]).is_ok());
/// assert_eq!(Run::<f64, 2>::new(&[front], &[155.0; 2]), Err(Error::ReadingMissing { row: 1 }));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
// Not logged: the complex numbers of `nalgebra` have no `Format`.
pub struct Run<T: Scalar, const ROWS: usize> {
    pub(crate) readings: [Complex<T>; ROWS],
    /// Speed of each (rad/s).
    pub(crate) speeds: [T; ROWS],
}

impl<T: Scalar, const ROWS: usize> Run<T, ROWS> {
    /// A run of readings, each with its speed (rad/s).
    ///
    /// # Errors
    /// [`Error::Size`], [`Error::ReadingMissing`] where there are fewer readings than speeds or the other way round,
    /// [`Error::Reading`] for a value that is not a number.
    pub fn new(readings: &[Complex<T>], speeds: &[T]) -> Result<Self, Error> {
        if readings.len() != speeds.len() {
            return Err(Error::ReadingMissing { row: readings.len().min(speeds.len()) });
        }
        if readings.is_empty() || readings.len() > ROWS {
            return Err(Error::Size);
        }
        let mut run = Run { readings: [zero(); ROWS], speeds: [T::zero(); ROWS] };
        let places = run.readings.iter_mut().zip(&mut run.speeds);
        for (row, ((to, at), (reading, speed))) in places.zip(readings.iter().zip(speeds)).enumerate() {
            if !(given(*reading) && *speed > T::zero() && speed.is_finite()) {
                return Err(Error::Reading { row });
            }
            (*to, *at) = (*reading, *speed);
        }
        Ok(run)
    }

    /// The readings, zeros behind the last.
    pub fn readings(&self) -> &[Complex<T>; ROWS] {
        &self.readings
    }
}
