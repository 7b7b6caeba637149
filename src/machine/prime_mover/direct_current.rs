//! The direct-current series motor, unsaturated, brushes and iron without loss.

use crate::machine::error::{Error, not_negative, positive};
use crate::machine::{Speed, Torque};

/// A series motor: `tau = c I^2`, `I = U/(R + c omega)` [derived; shape: Wang 1989 §1-2]. Without load it runs away.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[doc(alias("DC motor", "direct-current motor"))]
pub struct Series {
    /// Voltage (V).
    pub voltage: f64,
    /// Resistance of armature, field and starter (ohm).
    pub resistance: f64,
    /// Torque over the square of the current (H).
    pub flux: f64,
}

impl Series {
    stops! {
        /// From voltage (V), resistance (ohm) and torque over the square of the current (H).
        pub const fn new(voltage: f64, resistance: f64, flux: f64) -> Self = try_new
    }

    /// [`new`](Self::new), with an error for a value out of range.
    ///
    /// # Errors
    /// [`Error::DirectCurrent`].
    pub const fn try_new(voltage: f64, resistance: f64, flux: f64) -> Result<Self, Error> {
        if positive(voltage) && not_negative(resistance) && positive(flux) {
            Ok(Self { voltage, resistance, flux })
        } else {
            Err(Error::DirectCurrent)
        }
    }

    /// Current at a speed (A), for speeds above `-R/c`: overhauled backwards beyond that, it builds up its own field
    /// without bound.
    #[must_use]
    pub const fn current(&self, speed: Speed) -> f64 {
        self.voltage / (self.resistance + self.flux * speed.0)
    }

    /// Torque at a speed above `-R/c`.
    #[must_use]
    pub const fn torque(&self, speed: Speed) -> Torque {
        let current = self.current(speed);
        Torque(self.flux * current * current)
    }

    /// Stiffness of the characteristic at a speed above `-R/c` (N m s/rad).
    #[must_use]
    pub const fn stiffness(&self, speed: Speed) -> f64 {
        let current = self.current(speed);
        (2.0 * self.flux * self.flux * current * current * current / self.voltage).abs()
    }
}
