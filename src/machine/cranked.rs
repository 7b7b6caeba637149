//! A machine with a crank: its inertia at the motor, over a turn of the crank.

use core::f64::consts::TAU;

use super::error::positive;
use super::{CrankSlider, Error, Inertia, VariableInertia};

/// A rigid machine whose motor turns a crank drive, directly or through a gear; everything referred to the motor.
///
/// ```
/// use driveline::machine::{CrankSlider, Cranked, Inertia, Length, Mass};
///
/// // A press: motor and flywheel of 1.2 kg m2, a gear of 11 to 1, a ram of 400 kg on a crank of 0.1 m.
/// const RAM: CrankSlider = CrankSlider::massless_rod(Length(0.1), Length(0.6), Inertia(9.0), Mass(400.0));
/// const PRESS: Cranked = Cranked::new(Inertia(1.2), &RAM, 1, 11);
/// assert!(PRESS.mean_inertia() > 1.2 + 9.0 / 121.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Cranked {
    /// Inertia of the motor and all parts at a constant ratio to it (kg m2).
    pub constant: f64,
    /// The crank drive, on its own shaft.
    pub crank: CrankSlider,
    /// Turns of the crank ...
    pub turns: i32,
    /// ... to turns of the motor.
    pub motor_turns: u32,
}

impl Cranked {
    /// A machine of a motor and a crank that turns `turns` times while the motor turns `motor_turns` times; negative
    /// `turns` where it turns the other way.
    ///
    /// # Panics
    /// At compile time in a constant, with the sentence of the [`Error`] that [`try_new`](Self::try_new) returns.
    #[must_use]
    pub const fn new(constant: Inertia, crank: &CrankSlider, turns: i32, motor_turns: u32) -> Self {
        match Self::try_new(constant, crank, turns, motor_turns) {
            Ok(machine) => machine,
            Err(error) => error.stop(),
        }
    }

    /// [`new`](Self::new), with an error for a value out of range.
    ///
    /// # Errors
    /// [`Error::MotorInertia`], [`Error::GearRatio`], [`Error::CrankRadius`], [`Error::CrankMass`].
    pub const fn try_new(constant: Inertia, crank: &CrankSlider, turns: i32, motor_turns: u32) -> Result<Self, Error> {
        if let Err(error) = crank.check() {
            return Err(error);
        }
        if !positive(constant.0) {
            return Err(Error::MotorInertia);
        }
        if turns == 0 || motor_turns == 0 {
            return Err(Error::GearRatio);
        }
        Ok(Self { constant: constant.0, crank: *crank, turns, motor_turns })
    }

    /// Turns of the crank to one of the motor.
    #[must_use]
    pub const fn ratio(&self) -> f64 {
        self.turns as f64 / self.motor_turns as f64
    }

    /// Inertia at the motor, and its derivative by the motor's angle, with the crank at an angle (rad) from its top
    /// dead centre.
    ///
    /// Referred by the ratio r: `J_m + r^2 J(phi)`, `r^3 J'(phi)` [derived from Wang 1989 (1-15)].
    #[must_use]
    pub const fn inertia(&self, crank_angle: f64) -> VariableInertia {
        let r = self.ratio();
        let VariableInertia { inertia, derivative } = self.crank.inertia(crank_angle);
        VariableInertia { inertia: self.constant + r * r * inertia, derivative: r * r * r * derivative }
    }

    /// Mean inertia over a turn of the crank (kg m2).
    #[must_use]
    pub const fn mean_inertia(&self) -> f64 {
        let r = self.ratio();
        self.constant + r * r * self.crank.mean_inertia().0
    }

    /// Least and largest inertia over a turn of the crank (kg m2), of 256 angles.
    #[must_use]
    pub const fn extremes(&self) -> [f64; 2] {
        let first = self.inertia(0.0).inertia;
        let [mut least, mut most] = [first, first];
        let mut j = 1;
        while j < 256 {
            let inertia = self.inertia(j as f64 * (TAU / 256.0)).inertia;
            if inertia < least {
                least = inertia;
            }
            if inertia > most {
                most = inertia;
            }
            j += 1;
        }
        [least, most]
    }
}
