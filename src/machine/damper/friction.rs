//! The friction damper.

use core::f64::consts::{FRAC_PI_2, PI, SQRT_2};

use super::Resonance;
use crate::math::sqrt;

/// A ring that slips on its hub against dry friction.
///
/// The hub swings as a sine, and the ring slips all the time: up to a torque of 0.84 times `2/pi J_d omega^2 phi`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FrictionDamper {
    /// Inertia of the ring (kg m2).
    pub inertia: f64,
    /// Friction torque (N m).
    pub torque: f64,
}

impl FrictionDamper {
    /// The torque that takes most energy from a hub of this amplitude (rad) and frequency (rad/s):
    /// `sqrt(2)/pi J_d omega^2 phi`.
    #[must_use]
    pub const fn best(inertia: super::Inertia, amplitude: f64, frequency: f64) -> Self {
        Self { inertia: inertia.0, torque: SQRT_2 / PI * inertia.0 * frequency * frequency * amplitude }
    }

    /// Energy that it takes in a period (J): `4 tau phi sqrt(1 - x^2)`, `x = pi tau/(2 J_d omega^2 phi)`; NaN where
    /// the ring cannot slip at all.
    #[must_use]
    pub const fn energy(&self, amplitude: f64, frequency: f64) -> f64 {
        let x = FRAC_PI_2 * self.torque / (self.inertia * frequency * frequency * amplitude);
        4.0 * self.torque * amplitude * sqrt((1.0 - x) * (1.0 + x))
    }
}

impl Resonance {
    /// Amplitude over the static angle at the natural frequency with the best friction damper, which takes what the
    /// torque supplies: `pi^2/(4 mu)`.
    #[must_use]
    pub const fn friction_amplitude(mass_ratio: f64) -> f64 {
        0.25 * PI * PI / mass_ratio
    }

    /// The best friction damper of a ring against a torque (N m) at the natural frequency.
    #[must_use]
    pub const fn friction_damper(&self, ring: super::Inertia, torque: f64) -> FrictionDamper {
        let amplitude = Self::friction_amplitude(ring.0 / self.inertia) * torque / self.stiffness();
        FrictionDamper::best(ring, amplitude, self.frequency)
    }
}
