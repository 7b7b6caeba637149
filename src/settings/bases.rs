//! Bases of the fixed-point numbers.

use super::Error;
use crate::design::TwoMassDesign;
use crate::machine::TwoMass;

const BASE: &str =
    "the bases of fixed point must be positive and finite: check the machine and the largest torque and speed";

/// Bases of the fixed-point numbers of a drive.
///
/// A state is reported beyond its base and held at twice it; choose the limits so that the healthy machine stays
/// within.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Bases {
    /// Base of every torque (N m).
    pub torque: f64,
    /// Base of every speed (rad/s).
    pub speed: f64,
    /// Base of the twist (rad).
    pub twist: f64,
    /// Base of the twist rate (rad/s).
    pub twist_rate: f64,
    /// Base of the twist forcing s (rad/s2).
    pub forcing: f64,
}

impl Bases {
    /// All one: SI units, as floats have them.
    pub const SI: Bases = Bases { torque: 1.0, speed: 1.0, twist: 1.0, twist_rate: 1.0, forcing: 1.0 };

    /// Bases for a machine whose torques, in motor and shaft, stay within `torque` (N m) and whose speeds stay within
    /// `speed` (rad/s).
    ///
    /// The base of the twist is the twist under 1.9 times the base of the torque (a shaft coefficient k twist/torque
    /// must stay under 2). That of the twist rate is the rate at which this twist oscillates, limited by the speeds and
    /// the damper.
    pub const fn new(machine: &TwoMass, torque: f64, speed: f64) -> Bases {
        let twist = 1.9 * torque / machine.stiffness;
        let mut twist_rate = machine.resonance() * twist;
        if machine.damping * twist_rate > 1.9 * torque {
            twist_rate = 1.9 * torque / machine.damping;
        }
        if twist_rate > 2.0 * speed {
            twist_rate = 2.0 * speed;
        }
        let lighter =
            if machine.motor_inertia < machine.load_inertia { machine.motor_inertia } else { machine.load_inertia };
        Bases {
            torque,
            speed,
            twist,
            twist_rate,
            // The lighter mass's coefficient torque/(J forcing) just under 1/2.
            forcing: torque / (0.49 * lighter),
        }
    }

    /// Checks that each base is positive and finite.
    pub(super) const fn check(&self) -> Result<(), Error> {
        let bases = [self.torque, self.speed, self.twist, self.twist_rate, self.forcing];
        each!(k, 0..5, {
            if !(bases[k] > 0.0 && bases[k].is_finite()) {
                return Err(Error::Value(BASE));
            }
        });
        Ok(())
    }

    /// Bases for a design; see [`Bases::new`].
    pub const fn of(design: &TwoMassDesign, torque: f64, speed: f64) -> Bases {
        Bases::new(&design.machine, torque, speed)
    }

    /// Bases for a rigid machine, which has no twist.
    pub const fn rigid(torque: f64, speed: f64) -> Bases {
        Bases { torque, speed, ..Bases::SI }
    }
}
