//! Complex amplitudes by size and angle, as a balancer writes them.

use nalgebra::Complex;

/// Makes complex amplitudes of sizes and angles.
pub struct Polar;

impl Polar {
    /// Of a size and an angle (degrees).
    #[must_use]
    pub fn degrees(size: f64, angle: f64) -> Complex<f64> {
        Complex::from_polar(size, angle.to_radians())
    }

    /// Size and angle (degrees), the angle from 0 to 360.
    #[must_use]
    pub fn of(value: Complex<f64>) -> (f64, f64) {
        (value.norm(), value.arg().to_degrees().rem_euclid(360.0))
    }
}
