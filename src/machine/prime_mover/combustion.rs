//! The combustion engine: its full-load curve, and the governor's line above rated speed.

use crate::machine::error::{Error, positive};
use crate::machine::{Speed, Torque};

/// How an engine burns, which shapes its full-load curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum CombustionType {
    /// Spark ignition.
    Spark,
    /// Diesel with a chamber before the cylinder.
    IndirectInjection,
    /// Diesel with direct injection.
    DirectInjection,
}

impl CombustionType {
    /// Coefficients a, b, c of `P/P_N = a x + b x^2 - c x^3`, `x = omega/omega_N`: the relation of Leiderman and
    /// Khlystov with the coefficients of Jazar, Vehicle Dynamics, ch. 4. They are of naturally aspirated engines; a
    /// turbocharged one needs its own curve.
    const fn coefficients(self) -> [f64; 3] {
        match self {
            Self::Spark => [1.0, 1.0, 1.0],
            Self::IndirectInjection => [0.6, 1.4, 1.0],
            Self::DirectInjection => [0.87, 1.13, 1.0],
        }
    }
}

/// An engine at full load from idle to rated speed, `tau = tau_N (a + b x - c x^2)`; from there the governor takes the
/// torque down to zero at the speed without load, in a straight line, and there is none beyond. Below idle it stalls:
/// no torque.
///
/// This is the mean over a working cycle.
///
/// ```
/// use driveline::machine::{Combustion, CombustionType, Speed, Torque};
/// // 400 kW at 1500 r/min, 1560 r/min without load
/// const RATED: (Speed, Torque) = (Speed::rpm(1500.0), Torque(2546.0));
/// const DIESEL: Combustion =
///     Combustion::new(CombustionType::DirectInjection, RATED, Speed::rpm(600.0), Speed::rpm(1560.0));
/// assert!((DIESEL.droop() - 0.04).abs() < 1e-12); // 60 of 1500
/// assert!((DIESEL.torque(Speed::rpm(1530.0)).0 - 1273.0).abs() < 1e-9); // halfway down the governor's line
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[doc(alias("diesel", "engine"))]
pub struct Combustion {
    /// How it burns.
    pub mixture: CombustionType,
    /// Rated torque (N m): rated power over rated speed.
    pub rated_torque: f64,
    /// Rated speed (rad/s).
    pub rated_speed: f64,
    /// Lowest speed that it runs at (rad/s).
    pub idle: f64,
    /// Speed without load under its governor (rad/s).
    pub no_load: f64,
}

impl Combustion {
    stops! {
        /// From the rated point, the idle speed and the speed without load.
        pub const fn new(mixture: CombustionType, rated: (Speed, Torque), idle: Speed, no_load: Speed) -> Self = try_new
    }

    /// [`new`](Self::new), with an error for a value out of range.
    ///
    /// # Errors
    /// [`Error::CombustionEngine`].
    pub const fn try_new(
        mixture: CombustionType,
        rated: (Speed, Torque),
        idle: Speed,
        no_load: Speed,
    ) -> Result<Self, Error> {
        let rising = positive(idle.0) && idle.0 < rated.0.0 && rated.0.0 < no_load.0 && no_load.0.is_finite();
        if !(rising && positive(rated.1.0)) {
            return Err(Error::CombustionEngine);
        }
        Ok(Self { mixture, rated_torque: rated.1.0, rated_speed: rated.0.0, idle: idle.0, no_load: no_load.0 })
    }

    /// Largest torque at a speed.
    #[must_use]
    pub const fn torque(&self, speed: Speed) -> Torque {
        let w = speed.0;
        if !(w >= self.idle && w < self.no_load) {
            return Torque(0.0);
        }
        if w > self.rated_speed {
            return Torque(self.rated_torque * (self.no_load - w) / (self.no_load - self.rated_speed));
        }
        let [a, b, c] = self.mixture.coefficients();
        let x = w / self.rated_speed;
        Torque(self.rated_torque * (a + x * (b - c * x)))
    }

    /// Slope of the torque at a speed (N m s/rad); at a corner that above it.
    #[must_use]
    pub const fn slope(&self, speed: Speed) -> f64 {
        let w = speed.0;
        if !(w >= self.idle && w < self.no_load) {
            return 0.0;
        }
        if w >= self.rated_speed {
            return -self.rated_torque / (self.no_load - self.rated_speed);
        }
        let [_, b, c] = self.full_load();
        b + 2.0 * c * w
    }

    /// The full-load curve as a polynomial in the speed (rad/s), lowest first.
    pub(crate) const fn full_load(&self) -> [f64; 3] {
        let [a, b, c] = self.mixture.coefficients();
        let (torque, speed) = (self.rated_torque, self.rated_speed);
        [torque * a, torque * b / speed, -torque * c / (speed * speed)]
    }

    /// Largest torque over rated torque, `a + b^2/(4 c)`.
    #[must_use]
    pub const fn overload(&self) -> f64 {
        let [a, b, c] = self.mixture.coefficients();
        a + b * b / (4.0 * c)
    }

    /// Droop of the governor: fall of the speed from no load to rated load, over rated speed.
    #[must_use]
    pub const fn droop(&self) -> f64 {
        (self.no_load - self.rated_speed) / self.rated_speed
    }
}
