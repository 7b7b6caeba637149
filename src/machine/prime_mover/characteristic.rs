//! Any characteristic as one type: torque and slope at a speed, for what is designed from them.

use super::{Induction, Line, Parabola, Series};
use crate::machine::{Speed, Torque};

/// A characteristic of a prime mover, or of a load: torque against speed [Wang 1989 §1-2].
///
/// | prime mover | shape | source |
/// |---|---|---|
/// | [`Line`] | straight line through two points; a shunt motor, any motor near its rated point | [Wang 1989 (1-6)] |
/// | [`Parabola`] | through three points of a measured curve | [Wang 1989 (1-7)] |
/// | [`Induction`] | with breakdown torque; with rotor resistance for cranes | [Wang 1989 (1-8)], Kloss 1909 |
/// | [`Series`] | direct-current motor from voltage, resistance and flux | derived; shape: Wang 1989 §1-2 |
/// | [`Characteristic`] | any of them, with its slope | |
/// | [`StartingLaw`](super::StartingLaw) | `tau`, `tau (1 - t/T)`, `tau (1 - t^2/T^2)` | [Huang 1987 §2.2] |
///
/// Torques are in N m, speeds in rad/s, at the motor's shaft. The stiffness of a characteristic is `|d tau/d omega|`
/// (N m s/rad): it damps the machine where the torque falls with the speed. The overload capacity is the largest
/// torque over the rated one.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Characteristic {
    /// A straight line.
    Line(Line),
    /// A parabola; as a load a fan or a pump.
    Parabola(Parabola),
    /// A series motor.
    Series(Series),
    /// An induction motor.
    Induction(Induction),
}

impl Characteristic {
    /// Torque at a speed.
    #[must_use]
    pub const fn torque(&self, speed: Speed) -> Torque {
        match self {
            Self::Line(line) => line.torque(speed),
            Self::Parabola(parabola) => parabola.torque(speed),
            Self::Series(motor) => motor.torque(speed),
            Self::Induction(motor) => motor.torque(speed),
        }
    }

    /// Slope `d tau/d omega` at a speed (N m s/rad), negative where the torque falls with the speed.
    #[must_use]
    pub const fn slope(&self, speed: Speed) -> f64 {
        match self {
            Self::Line(line) => -line.slope,
            Self::Parabola(parabola) => parabola.linear + 2.0 * parabola.square * speed.0,
            Self::Series(motor) => -motor.stiffness(speed),
            Self::Induction(motor) => {
                let slip = 1.0 - speed.0 / motor.synchronous;
                let falls = slip.abs() < motor.breakdown_slip;
                if falls { -motor.stiffness(speed) } else { motor.stiffness(speed) }
            }
        }
    }
}
