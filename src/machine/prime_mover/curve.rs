//! A straight line through two points and a parabola through three.

use crate::machine::error::Error;
use crate::machine::{Speed, Torque};

/// A linear characteristic `tau = a - b omega` [Wang 1989 (1-6)].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Line {
    /// Torque at standstill (N m).
    pub stall: f64,
    /// Fall of the torque with the speed (N m s/rad): the stiffness of the characteristic.
    pub slope: f64,
}

impl Line {
    stops! {
        /// Through the rated point and the speed without load.
        pub const fn new(rated: (Speed, Torque), no_load: Speed) -> Self = try_new
    }

    /// [`new`](Self::new), with an error for a value out of range.
    ///
    /// # Errors
    /// [`Error::CharacteristicPoints`].
    pub const fn try_new(rated: (Speed, Torque), no_load: Speed) -> Result<Self, Error> {
        let slope = rated.1.0 / (no_load.0 - rated.0.0);
        if slope.is_finite() && no_load.0.is_finite() && no_load.0 != rated.0.0 {
            Ok(Self { stall: slope * no_load.0, slope })
        } else {
            Err(Error::CharacteristicPoints)
        }
    }

    /// Torque at a speed.
    #[must_use]
    pub const fn torque(&self, speed: Speed) -> Torque {
        Torque(self.stall - self.slope * speed.0)
    }
}

/// A parabola `tau = a + b omega + c omega^2` [Wang 1989 (1-7)].
///
/// ```
/// use driveline::machine::{Parabola, Speed, Torque};
/// // a fan: with the square of the speed
/// const FAN: Parabola =
///     Parabola::through([(Speed(0.0), Torque(0.0)), (Speed(50.0), Torque(25.0)), (Speed(100.0), Torque(100.0))]);
/// assert!((FAN.torque(Speed(150.0)).0 - 225.0).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Parabola {
    /// Torque at standstill a (N m).
    pub constant: f64,
    /// b (N m s/rad).
    pub linear: f64,
    /// c (N m s2/rad2).
    pub square: f64,
}

impl Parabola {
    stops! {
        /// Through three points.
        pub const fn through(points: [(Speed, Torque); 3]) -> Self = try_through
    }

    /// [`through`](Self::through), with an error for a value out of range.
    ///
    /// # Errors
    /// [`Error::CharacteristicPoints`].
    pub const fn try_through(points: [(Speed, Torque); 3]) -> Result<Self, Error> {
        let [(x0, y0), (x1, y1), (x2, y2)] = points;
        let (x0, x1, x2) = (x0.0, x1.0, x2.0);
        // Newton's divided differences.
        let first = (y1.0 - y0.0) / (x1 - x0);
        let square = ((y2.0 - y1.0) / (x2 - x1) - first) / (x2 - x0);
        let linear = first - square * (x0 + x1);
        let constant = y0.0 - x0 * (linear + square * x0);
        if x0 != x1 && x1 != x2 && x0 != x2 && square.is_finite() && constant.is_finite() {
            Ok(Self { constant, linear, square })
        } else {
            Err(Error::CharacteristicPoints)
        }
    }

    /// Torque at a speed.
    #[must_use]
    pub const fn torque(&self, speed: Speed) -> Torque {
        Torque(self.constant + speed.0 * (self.linear + self.square * speed.0))
    }

    /// Stiffness of the characteristic at a speed (N m s/rad).
    #[must_use]
    pub const fn stiffness(&self, speed: Speed) -> f64 {
        (self.linear + 2.0 * self.square * speed.0).abs()
    }
}
