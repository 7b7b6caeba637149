//! The three-phase induction motor, with the resistance of its rotor where it has slip rings.

use crate::machine::error::{Error, positive};
use crate::machine::{Speed, Torque};
use crate::math::sqrt;

/// An induction motor on a stiff supply, stator resistance neglected: `tau = 2 tau_A/(s/s_A + s_A/s)` with the slip
/// `s = 1 - omega/omega_0` (Kloss's formula).
///
/// It passes through the rated point where the breakdown speed is that of Wang 1989 (1-8). It brakes above synchronous
/// speed, and when turned backwards (plugging), as a crane when lowering.
///
/// ```
/// use driveline::machine::{Induction, Speed, Torque};
/// let motor = Induction::new(Speed(154.99), Torque(750.0), Speed(157.08), 2.5);
/// // the largest torque at the breakdown slip [Wang 1989 (1-8)]
/// let breakdown = Speed(motor.synchronous * (1.0 - motor.breakdown_slip));
/// assert!((motor.torque(breakdown).0 / 750.0 - 2.5).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[doc(alias("AC motor", "asynchronous motor", "Kloss"))]
pub struct Induction {
    /// Synchronous speed (rad/s).
    pub synchronous: f64,
    /// Largest torque (N m).
    pub breakdown: f64,
    /// Slip of the largest torque. It grows with the rotor's whole resistance over its own [derived; shape: Wang 1989
    /// §1-2], above 1 with much of it.
    pub breakdown_slip: f64,
}

impl Induction {
    stops! {
        /// From the rated point, the synchronous speed and the overload capacity (breakdown torque over rated torque).
        pub const fn new(rated_speed: Speed, rated: Torque, synchronous: Speed, overload: f64) -> Self = try_new
    }

    /// [`new`](Self::new), with an error for a value out of range.
    ///
    /// # Errors
    /// [`Error::InductionSpeed`], [`Error::CharacteristicPoints`], [`Error::Overload`].
    pub const fn try_new(rated_speed: Speed, rated: Torque, synchronous: Speed, overload: f64) -> Result<Self, Error> {
        if !(positive(rated_speed.0) && positive(synchronous.0) && rated_speed.0 < synchronous.0) {
            return Err(Error::InductionSpeed);
        }
        if !positive(rated.0) {
            return Err(Error::CharacteristicPoints);
        }
        if !(overload > 1.0 && overload.is_finite()) {
            return Err(Error::Overload);
        }
        let slip = (synchronous.0 - rated_speed.0) / synchronous.0;
        let steepness = overload + sqrt((overload - 1.0) * (overload + 1.0));
        Ok(Self { synchronous: synchronous.0, breakdown: overload * rated.0, breakdown_slip: slip * steepness })
    }

    /// Torque at a speed.
    #[must_use]
    pub const fn torque(&self, speed: Speed) -> Torque {
        let (s, a) = (1.0 - speed.0 / self.synchronous, self.breakdown_slip);
        Torque(2.0 * self.breakdown * s * a / (s * s + a * a))
    }

    /// Stiffness of the characteristic at a speed (N m s/rad), without regard to its sign: below the breakdown speed
    /// the torque rises with the speed, and the machine is driven off that branch.
    #[must_use]
    pub const fn stiffness(&self, speed: Speed) -> f64 {
        let (s, a) = (1.0 - speed.0 / self.synchronous, self.breakdown_slip);
        let sum = s * s + a * a;
        (2.0 * self.breakdown * a * (a - s) * (a + s) / (sum * sum) / self.synchronous).abs()
    }
}
