//! Result of the commissioning test.

use super::{Eccentricity, Error, Figure, Friction};
use crate::machine::{Damping, Gap, Inertia, Stiffness, Torque, TwoMass};

/// The identified machine, referred to the motor.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CommissioningResult {
    /// Total inertia (kg m2).
    pub total_inertia: Figure,
    /// Inertia on the motor's side (kg m2).
    pub motor_inertia: Figure,
    /// Inertia on the load's side (kg m2).
    pub load_inertia: Figure,
    /// Resonance (rad/s).
    pub resonance: Figure,
    /// Antiresonance (rad/s).
    pub antiresonance: Figure,
    /// Stiffness (N m/rad).
    pub stiffness: Figure,
    /// Damping of the shaft (N m s/rad).
    pub damping: Figure,
    /// Damping ratio of the resonance.
    pub damping_ratio: Figure,
    /// Friction and weight.
    pub friction: Friction,
    /// The whole gap (rad), or why it could not be identified.
    pub gap: Result<Figure, Error>,
    /// Eccentricity of the encoder.
    pub eccentricity: Eccentricity,
}

impl CommissioningResult {
    /// The two-mass machine, for [`try_observer`](TwoMass::try_observer) and
    /// [`try_speed_loop`](TwoMass::try_speed_loop); without a gap where none was identified.
    ///
    /// # Errors
    /// The sentence of a figure that no machine can have.
    pub fn machine(&self) -> Result<TwoMass, crate::machine::Error> {
        let machine = TwoMass::try_new(
            Inertia(self.motor_inertia.value),
            Inertia(self.load_inertia.value),
            Stiffness(self.stiffness.value),
            Damping(self.damping.value),
        )?;
        let gap = self.gap.map_or(0.0, |gap| gap.value);
        let weight = self.friction.weight.value;
        if !(gap >= 0.0 && gap.is_finite()) {
            return Err(crate::machine::Error::BacklashGap);
        }
        if !weight.is_finite() {
            return Err(crate::machine::Error::GravityTorque);
        }
        Ok(machine.with_gap(Gap(gap)).with_gravity_torque(Torque(weight)))
    }
}
