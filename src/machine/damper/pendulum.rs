//! The centrifugal pendulum: an absorber whose frequency follows the speed.

use super::Damper;
use crate::machine::{Inertia, Length, Mass};
use crate::math::sqrt;

/// A point mass on a pendulum that hangs on a rotating disc, in small angles.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CentrifugalPendulum {
    /// Mass (kg).
    pub mass: f64,
    /// Distance of its pivot from the axis, R (m).
    pub radius: f64,
    /// Length of the pendulum, L (m).
    pub length: f64,
}

impl CentrifugalPendulum {
    /// A pendulum for an order: length `R/nu^2`.
    #[must_use]
    pub const fn for_order(mass: Mass, radius: Length, order: f64) -> Self {
        Self { mass: mass.0, radius: radius.0, length: radius.0 / (order * order) }
    }

    /// The order that it absorbs at every speed: `sqrt(R/L)`.
    #[must_use]
    pub const fn order(&self) -> f64 {
        sqrt(self.radius / self.length)
    }

    /// The pendulum at a speed (rad/s) of the disc, as a ring on a spring: inertia `m (R + L)^2`, frequency `nu Omega`.
    #[must_use]
    pub const fn ring(&self, speed: f64) -> Damper {
        let arm = self.radius + self.length;
        Damper::absorber(Inertia(self.mass * arm * arm), self.order() * speed)
    }

    /// Inertia that it adds to the disc at an order (kg m2): `m (R + L)^2/(1 - nu^2 L/R)`; negative above its own
    /// order, infinite at it.
    #[must_use]
    pub const fn inertia(&self, order: f64) -> f64 {
        let arm = self.radius + self.length;
        self.mass * arm * arm / (1.0 - order * order * self.length / self.radius)
    }

    /// Swing of the pendulum (rad) that balances a torque (N m) of its own order at a speed (rad/s) of the disc:
    /// `tau/(m R (R + L) Omega^2)`.
    #[must_use]
    pub const fn swing(&self, torque: f64, speed: f64) -> f64 {
        torque / (self.mass * self.radius * (self.radius + self.length) * speed * speed)
    }
}
