//! Torque of one cylinder by orders: of its gas and of its masses.

use core::f64::consts::{PI, TAU};

use super::WorkingCycle;
use crate::machine::{CrankSlider, Diameter};
use crate::math::{hypot, sin_cos};

/// Angles of a turn that the mass torque is taken at.
const ANGLES: usize = 256;

/// One order of a torque: `cosine cos(nu phi) + sine sin(nu phi)` (N m).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Harmonic {
    /// Cosine part.
    pub cosine: f64,
    /// Sine part.
    pub sine: f64,
}

impl Harmonic {
    /// Amplitude.
    #[must_use]
    pub const fn amplitude(&self) -> f64 {
        hypot(self.cosine, self.sine)
    }
}

impl CrankSlider {
    /// Torque of the masses at the crank at a steady speed (rad/s): the sine amplitudes (N m) of the orders 0, 1, 2
    /// ..., `N` of them; `-J'(phi) omega^2/2` [Pfützner 1980 (1.2a) to (1.2c); the connecting rod: derived].
    ///
    /// These are all powers of lambda: the second order of a massless rod is
    /// `-m r^2 omega^2 (1/2 + lambda^4/32 + ...)`. By 256 equidistant angles, which is exact to rounding for orders
    /// below 64 up to lambda 0.9.
    #[must_use]
    pub const fn mass_torque<const N: usize>(&self, speed: f64) -> [f64; N] {
        let mut sines = [0.0; N];
        each!(j, 0..ANGLES, {
            let torque = -0.5 * self.inertia(j as f64 * (TAU / ANGLES as f64)).derivative * speed * speed;
            each!(k, 0..N, {
                sines[k] +=
                    torque * sin_cos(((k * j) % ANGLES) as f64 * (TAU / ANGLES as f64)).0 / (0.5 * ANGLES as f64);
            });
        });
        sines
    }

    /// Torque of the gas at the crank by orders (N m), from an indicator diagram: index `k` is `k` times the cycle's
    /// lowest order, index 0 the mean [Pfützner 1980 (1.2a) to (1.2c)].
    ///
    /// `pressure` (Pa) above that in the crankcase, at equidistant crank angles over a whole cycle, the first at the
    /// firing dead centre. It resolves the orders of an index below half its length.
    #[must_use]
    pub const fn gas_torque<const N: usize>(
        &self,
        bore: Diameter,
        pressure: &[f64],
        cycle: WorkingCycle,
    ) -> [Harmonic; N] {
        let mut orders = [Harmonic { cosine: 0.0, sine: 0.0 }; N];
        let area = 0.25 * PI * bore.0 * bore.0;
        let count = pressure.len();
        each!(j, 0..count, {
            let angle = cycle.angle() * (j as f64 / count as f64);
            let torque = pressure[j] * area * self.travel(angle).first / count as f64;
            each!(k, 0..N, {
                let (sine, cosine) = sin_cos(((k * j) % count) as f64 * (TAU / count as f64));
                let twice = if k == 0 { torque } else { 2.0 * torque };
                orders[k].cosine += twice * cosine;
                orders[k].sine += twice * sine;
            });
        });
        orders
    }
}
