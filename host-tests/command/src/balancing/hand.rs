//! The hand that sets a weight: never quite as much, never quite there.

use nalgebra::Complex;

use driveline_solver::noise::Noise;

/// Sets weights with errors of this standard deviation.
pub struct Hand {
    /// Of the amount, as a share.
    amount: f64,
    /// Of the angle [rad].
    angle: f64,
    source: Noise,
}

impl Hand {
    /// A hand with errors of the amount, as a share, and of the angle [degrees]; `seed` is that of its errors.
    #[must_use]
    pub fn new(amount: f64, degrees: f64, seed: u64) -> Self {
        Hand { amount, angle: degrees.to_radians(), source: Noise::new(seed) }
    }

    /// A weight as it is set.
    pub fn set(&mut self, wanted: Complex<f64>) -> Complex<f64> {
        let (amount, angle) = (1.0 + self.amount * self.source.normal(), self.angle * self.source.normal());
        wanted * Complex::from_polar(amount, angle)
    }
}
