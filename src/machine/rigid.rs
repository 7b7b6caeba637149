//! One mass: a machine whose shafts are stiff enough to be left out.

use super::error::positive;
use super::{Chain, Error, Inertia};

/// A machine that turns as one, referred to the motor: `J omega' = tau_m - tau_L`.
///
/// ```
/// use driveline::machine::{Chain, Damping, Efficiency, Inertia, Ratio, Rigid, Stiffness};
/// const SPINDLE: Chain = Chain::motor(Inertia(0.02)).shaft(Stiffness(4.0e5), Damping(1.0)).rotor(Inertia(0.01))
///     .gear(Ratio(2.0), Efficiency(0.98)).rotor(Inertia(0.04));
/// const WHOLE: Rigid = SPINDLE.rigid();
/// assert!((WHOLE.inertia - (0.02 + 0.01 + 0.04 / 4.0)).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Rigid {
    /// Inertia of the whole machine (kg m2).
    pub inertia: f64,
    /// Torque of the weight at the motor (N m), without losses; positive where it decelerates.
    pub gravity_torque: f64,
}

impl Rigid {
    stops! {
        /// A machine of this inertia, without weight.
        pub const fn new(inertia: Inertia) -> Self = try_new
    }

    /// [`new`](Self::new), with an error for a value out of range.
    ///
    /// # Errors
    /// [`Error::MotorInertia`].
    pub const fn try_new(inertia: Inertia) -> Result<Self, Error> {
        if positive(inertia.0) {
            Ok(Self { inertia: inertia.0, gravity_torque: 0.0 })
        } else {
            Err(Error::MotorInertia)
        }
    }
}

impl Chain {
    stops! {
        /// The whole chain as one mass.
        pub const fn rigid(&self) -> Rigid = try_rigid
    }

    /// [`rigid`](Self::rigid), with an error instead of a panic.
    ///
    /// # Errors
    /// As [`check`](Self::check).
    pub const fn try_rigid(&self) -> Result<Rigid, Error> {
        get!(self.check());
        Ok(Rigid { inertia: self.total_inertia(), gravity_torque: self.gravity_torque() })
    }
}
