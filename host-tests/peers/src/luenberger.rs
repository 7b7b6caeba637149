//! Gains of a Luenberger observer: five poles of Butterworth's pattern, placed by Ackermann's formula [Ackermann 1972,
//! Regelungstechnik 20(7)].
//!
//! In increments over a tick, `(A - 1)/T`, and in states and times scaled by the poles' radius, so that all numbers are
//! near one: of the plain sampled machine the observability matrix is singular to working precision.

use driveline::design::TwoMassDesign;
use nalgebra::{SMatrix, SVector};

/// Coefficients of Butterworth's polynomial of fifth order, from `s^0` to `s^4` [Butterworth 1930]; with phi the golden
/// ratio these are `1, 2 phi, 2 phi + 2, 2 phi + 2, 2 phi`.
const BUTTERWORTH: [f64; 5] =
    [1.0, 3.236_067_977_499_79, 5.236_067_977_499_79, 5.236_067_977_499_79, 3.236_067_977_499_79];

/// Corrections of the five states per radian of innovation, with the poles on a circle of `radius` (rad/s); none where
/// they cannot be placed.
pub fn gains(design: &TwoMassDesign, radius: f64) -> Option<[f32; 5]> {
    let period = design.period;
    let transition = SMatrix::<f64, 5, 5>::from(design.transition.0).transpose();
    // States in units that all are about as large as the angle.
    let inertia = design.machine.motor_inertia;
    let scale = SVector::<f64, 5>::from([1.0, radius, 1.0, radius, radius * radius * inertia]);
    let increments = (transition - SMatrix::identity()) / (period * radius);
    let scaled = SMatrix::<f64, 5, 5>::from_fn(|row, column| increments[(row, column)] * scale[column] / scale[row]);
    let mut observability = SMatrix::<f64, 5, 5>::zeros();
    let mut row = SMatrix::<f64, 1, 5>::zeros();
    row[0] = 1.0;
    for k in 0..5 {
        observability.set_row(k, &row);
        row *= scaled;
    }
    let mut polynomial = SMatrix::<f64, 5, 5>::identity();
    for coefficient in BUTTERWORTH.into_iter().rev() {
        polynomial = polynomial * scaled + SMatrix::identity() * coefficient;
    }
    let mut last = SVector::<f64, 5>::zeros();
    last[4] = 1.0;
    let placed = polynomial * observability.lu().solve(&last)?;
    // Of the prediction's error `A - L C`, in the increments' time; `A K = L` for the correction after a measurement.
    let prediction = SVector::<f64, 5>::from_fn(|k, _| placed[k] * scale[k] * period * radius);
    let correction = transition.lu().solve(&prediction)?;
    correction.iter().all(|value| value.is_finite()).then(|| correction.map(|value| value as f32).into())
}
