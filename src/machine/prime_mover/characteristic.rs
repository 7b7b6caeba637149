//! Any characteristic as one type: torque and slope at a speed, for what is designed from them.

use super::{Combustion, Induction, Line, Parabola, Series, Shunt};
use crate::machine::{Speed, Torque};

/// A characteristic of a prime mover, or of a load: torque against speed [Wang 1989 §1-2].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Characteristic {
    /// A straight line.
    Line(Line),
    /// A parabola; as a load a fan or a pump.
    Parabola(Parabola),
    /// A shunt motor.
    Shunt(Shunt),
    /// A series motor.
    Series(Series),
    /// An induction motor.
    Induction(Induction),
    /// A combustion engine at full load.
    Combustion(Combustion),
}

impl Characteristic {
    /// Torque at a speed.
    #[must_use]
    pub const fn torque(&self, speed: Speed) -> Torque {
        match self {
            Self::Line(line) => line.torque(speed),
            Self::Parabola(parabola) => parabola.torque(speed),
            Self::Shunt(motor) => motor.torque(speed),
            Self::Series(motor) => motor.torque(speed),
            Self::Induction(motor) => motor.torque(speed),
            Self::Combustion(engine) => engine.torque(speed),
        }
    }

    /// Slope `d tau/d omega` at a speed (N m s/rad), negative where the torque falls with the speed; at a corner of an
    /// engine's curve that above it.
    #[must_use]
    pub const fn slope(&self, speed: Speed) -> f64 {
        match self {
            Self::Line(line) => -line.slope,
            Self::Parabola(parabola) => parabola.linear + 2.0 * parabola.square * speed.0,
            Self::Shunt(motor) => -motor.stiffness(),
            Self::Series(motor) => -motor.stiffness(speed),
            Self::Induction(motor) => {
                let slip = 1.0 - speed.0 / motor.synchronous;
                let falls = slip.abs() < motor.breakdown_slip;
                if falls { -motor.stiffness(speed) } else { motor.stiffness(speed) }
            }
            Self::Combustion(engine) => engine.slope(speed),
        }
    }
}
