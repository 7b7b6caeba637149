//! A machine with a mechanism: its inertia at the motor, over a turn of the crank.

use super::error::positive;
use super::{Error, Inertia, MECHANISM_POINTS, Mechanism, MechanismPoint};

/// A rigid machine whose motor turns a mechanism, directly or through a gear; everything referred to the motor.
///
/// ```
/// use driveline::machine::{CrankSlider, DrivenMechanism, Inertia, Length, Mass, Mechanism};
///
/// // A press: motor and flywheel of 1.2 kg m2, a gear of 11 to 1, a ram of 400 kg on a crank of 0.1 m.
/// const RAM: CrankSlider = CrankSlider::massless_rod(Length(0.1), Length(0.6), Inertia(9.0), Mass(400.0));
/// const PRESS: DrivenMechanism = DrivenMechanism::new(Inertia(1.2), &Mechanism::slider_crank(&RAM), 1, 11);
/// assert!(PRESS.mean_inertia() > 1.2 + 9.0 / 121.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct DrivenMechanism {
    /// Inertia of the motor and all parts at a constant ratio to it (kg m2).
    pub constant: f64,
    /// The mechanism, on its own shaft.
    pub mechanism: Mechanism,
    /// Turns of the crank ...
    pub turns: i32,
    /// ... to turns of the motor.
    pub motor_turns: u32,
}

impl DrivenMechanism {
    stops! {
        /// A machine of a motor and a mechanism whose crank turns `turns` times while the motor turns `motor_turns`
        /// times; negative `turns` where it turns the other way.
        pub const fn new(constant: Inertia, mechanism: &Mechanism, turns: i32, motor_turns: u32) -> Self = try_new
    }

    /// [`new`](Self::new), with an error for a value out of range.
    ///
    /// # Errors
    /// That of the mechanism, [`Error::MotorInertia`], [`Error::GearRatio`], and [`Error::MechanismInertia`] where the
    /// inertia is not positive everywhere or the weight is not finite.
    pub const fn try_new(
        constant: Inertia,
        mechanism: &Mechanism,
        turns: i32,
        motor_turns: u32,
    ) -> Result<Self, Error> {
        if let Some(error) = mechanism.error() {
            return Err(error);
        }
        if !positive(constant.0) {
            return Err(Error::MotorInertia);
        }
        if turns == 0 || motor_turns == 0 {
            return Err(Error::GearRatio);
        }
        let machine = Self { constant: constant.0, mechanism: *mechanism, turns, motor_turns };
        if !(machine.extremes()[0] > 0.0 && machine.mean_inertia().is_finite() && mechanism.weight.is_finite()) {
            return Err(Error::MechanismInertia);
        }
        Ok(machine)
    }

    /// Turns of the crank to one of the motor.
    #[must_use]
    pub const fn ratio(&self) -> f64 {
        self.turns as f64 / self.motor_turns as f64
    }

    /// Inertia, its derivative by the motor's angle and the tool's travel by it, at a point of the turn.
    ///
    /// Referred by the ratio r: `J_m + r^2 J(phi)`, `r^3 J'(phi)`, `r y'(phi)` [derived from Wang 1989 (1-15)].
    #[must_use]
    pub const fn point(&self, point: usize) -> MechanismPoint {
        let r = self.ratio();
        let MechanismPoint { inertia, derivative, leverage } = self.mechanism.points[point % MECHANISM_POINTS];
        MechanismPoint {
            inertia: self.constant + r * r * inertia,
            derivative: r * r * r * derivative,
            leverage: r * leverage,
        }
    }

    /// Mean inertia over a turn of the crank (kg m2).
    #[must_use]
    pub const fn mean_inertia(&self) -> f64 {
        let r = self.ratio();
        self.constant + r * r * self.mechanism.mean_inertia().0
    }

    /// Least and largest inertia over a turn of the crank (kg m2), of the points.
    #[must_use]
    pub const fn extremes(&self) -> [f64; 2] {
        let first = self.point(0).inertia;
        let [mut least, mut most] = [first, first];
        each!(j, 1..MECHANISM_POINTS, {
            let inertia = self.point(j).inertia;
            // a NaN is neither: it becomes both
            if !(inertia >= least) {
                least = inertia;
            }
            if !(inertia <= most) {
                most = inertia;
            }
        });
        [least, most]
    }

    /// Largest leverage of the tool at the motor (m/rad), zero without a tool.
    #[must_use]
    pub const fn most_leverage(&self) -> f64 {
        let (mut most, mut j) = (0.0, 0);
        while j < MECHANISM_POINTS {
            let leverage = self.point(j).leverage.abs();
            if leverage > most {
                most = leverage;
            }
            j += 1;
        }
        most
    }
}
