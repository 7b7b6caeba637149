//! Two masses joined by one shaft: the observer's model of the machine.

use super::error::{not_negative, positive};
use super::{Damping, Error, Gap, Inertia, ReductionError, Stiffness, Torque};
use crate::math::sqrt;

/// A motor and a load joined by one damped shaft, all referred to the motor [derived; headings: Huang 1987 ch. 3 to 7].
///
/// `J_m phi_m'' = tau_m - tau_s`, `J_l phi_l'' = tau_s - tau_L`, `tau_s = k delta + d delta'` with the twist
/// `delta = phi_m - phi_l`.
///
/// ```
/// use driveline::machine::{Damping, Inertia, Stiffness, TwoMass};
/// let machine = TwoMass::new(Inertia(0.5), Inertia(0.5), Stiffness(1.0e4), Damping(0.0));
/// assert!((machine.resonance() - 200.0).abs() < 1e-9); // rad/s: the reduced inertia is 0.25 kg m2
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[doc(alias("torsional vibration", "resonance"))]
pub struct TwoMass {
    /// Inertia on the motor's side (kg m2).
    pub motor_inertia: f64,
    /// Inertia on the load's side (kg m2).
    pub load_inertia: f64,
    /// Stiffness (N m/rad).
    pub stiffness: f64,
    /// Damping (N m s/rad).
    pub damping: f64,
    /// Whole free travel of the backlash (rad); 0 without one.
    pub gap: f64,
    /// Torque of the weight at the motor (N m), without losses; positive where it decelerates.
    pub gravity_torque: f64,
    /// Errors of the reduction; all zero for a machine of two masses.
    pub error: ReductionError,
}

impl TwoMass {
    stops! {
        /// Two masses, without backlash or weight. The stiffness may be zero: two masses apart.
        pub const fn new(motor: Inertia, load: Inertia, stiffness: Stiffness, damping: Damping) -> Self = try_new
    }

    /// [`new`](Self::new), with an error for a value out of range.
    ///
    /// # Errors
    /// [`Error::MotorInertia`], [`Error::LoadInertia`], [`Error::ShaftStiffnessNegative`], [`Error::ShaftDamping`].
    pub const fn try_new(motor: Inertia, load: Inertia, stiffness: Stiffness, damping: Damping) -> Result<Self, Error> {
        let machine = Self {
            motor_inertia: motor.0,
            load_inertia: load.0,
            stiffness: stiffness.0,
            damping: damping.0,
            gap: 0.0,
            gravity_torque: 0.0,
            error: ReductionError::NONE,
        };
        machine.checked()
    }

    /// The machine, if it passes [`check`](Self::check).
    pub(super) const fn checked(self) -> Result<Self, Error> {
        get!(self.check());
        Ok(self)
    }

    /// The same with a backlash: the whole free travel (rad) at the motor.
    ///
    /// # Panics
    /// At compile time in a constant, where the gap is negative or not finite.
    #[must_use]
    pub const fn with_gap(mut self, gap: Gap) -> Self {
        if !not_negative(gap.0) {
            Error::BacklashGap.stop()
        }
        self.gap = gap.0;
        self
    }

    /// The same with a weight: its torque at the motor (N m).
    ///
    /// # Panics
    /// At compile time in a constant, where the torque is not finite.
    #[must_use]
    pub const fn with_gravity_torque(mut self, torque: Torque) -> Self {
        if !torque.0.is_finite() {
            Error::GravityTorque.stop()
        }
        self.gravity_torque = torque.0;
        self
    }

    /// Whether every field is in its range.
    ///
    /// # Errors
    /// The first [`Error`] found, in the order of the fields.
    pub const fn check(&self) -> Result<(), Error> {
        if !positive(self.motor_inertia) {
            Err(Error::MotorInertia)
        } else if !positive(self.load_inertia) {
            Err(Error::LoadInertia)
        } else if !not_negative(self.stiffness) {
            Err(Error::ShaftStiffnessNegative)
        } else if !not_negative(self.damping) {
            Err(Error::ShaftDamping)
        } else if !not_negative(self.gap) {
            Err(Error::BacklashGap)
        } else if !self.gravity_torque.is_finite() {
            Err(Error::GravityTorque)
        } else if !(self.total_inertia().is_finite()
            && (self.stiffness / self.reduced_inertia()).is_finite()
            && (self.damping / self.reduced_inertia()).is_finite())
        {
            Err(Error::Reduction)
        } else {
            Ok(())
        }
    }

    /// Sum of the inertias (kg m2).
    #[must_use]
    pub const fn total_inertia(&self) -> f64 {
        self.motor_inertia + self.load_inertia
    }

    /// Reduced inertia `J_m J_l / (J_m + J_l)` (kg m2).
    #[must_use]
    pub const fn reduced_inertia(&self) -> f64 {
        super::refer::series(self.motor_inertia, self.load_inertia)
    }

    /// Resonance with both ends free, undamped (rad/s).
    #[must_use]
    pub const fn resonance(&self) -> f64 {
        sqrt(self.stiffness / self.reduced_inertia())
    }

    /// Resonance with both ends free, damped (rad/s); 0 where nothing swings.
    pub(crate) const fn damped_resonance(&self) -> f64 {
        let ratio = self.damping_ratio();
        if ratio < 1.0 { self.resonance() * sqrt((1.0 - ratio) * (1.0 + ratio)) } else { 0.0 }
    }

    /// Antiresonance: resonance with the motor locked, undamped (rad/s).
    #[must_use]
    pub const fn antiresonance(&self) -> f64 {
        sqrt(self.stiffness / self.load_inertia)
    }

    /// Damping ratio of the resonance, 1 where it turns aperiodic; infinite for a damper without a spring.
    #[must_use]
    pub const fn damping_ratio(&self) -> f64 {
        if self.damping == 0.0 {
            return 0.0;
        }
        self.damping / (2.0 * self.reduced_inertia() * self.resonance())
    }
}
