//! Plausibility limits of a sample.

use super::convert::{get, or_stop, per_unit, positive};
use super::format::ANGLE_PER_RADIAN;
use super::{Bases, Error};
use crate::drive::Limits;
use crate::number::{Fixed, INNOVATION_RANGE, TURN_SHIFT};

const TORQUE: &str = "the largest plausible torque must be positive and finite, and at most twice the base of the \
    torque in fixed point";
const SETPOINT: &str = "the largest plausible setpoint must be positive and finite, and at most twice the base of the \
    speed in fixed point";
const STANDSTILL: &str =
    "the frozen-turn limit must be at least 0 and finite, and at most 5.6 degrees (0.098 rad) in fixed point";
const INNOVATION: &str =
    "the largest plausible innovation must be positive and at most 5.6 degrees (0.098 rad) in fixed point";

/// How samples are screened, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Screening {
    /// Largest plausible applied torque [N m].
    pub torque: f64,
    /// Largest plausible setpoint [rad/s].
    pub setpoint: f64,
    /// Largest plausible innovation \[rad\]: the motor's deviation under the largest torque before the observer has
    /// followed, at most 0.098 rad in fixed point.
    pub innovation: f64,
    /// Largest predicted turn in a tick for which an unchanged angle is plausible \[rad\]: two counts of the encoder.
    pub frozen_turn: f64,
    /// Ticks without a usable angle, less those with one, after which it counts as lost: no more than the motor needs
    /// for half a turn.
    pub max_coast: u32,
}

/// The limits in 2^-32 turns and SI units, each of them positive.
const fn checked(screening: &Screening) -> Result<[f64; 4], Error> {
    let frozen_turn = screening.frozen_turn * ANGLE_PER_RADIAN;
    if !(frozen_turn >= 0.0 && frozen_turn.is_finite()) {
        return Err(Error::Value(STANDSTILL));
    }
    Ok([
        get!(positive(screening.torque, TORQUE)),
        get!(positive(screening.setpoint, SETPOINT)),
        get!(positive(screening.innovation * ANGLE_PER_RADIAN, INNOVATION)),
        frozen_turn,
    ])
}

macro_rules! float {
    ($float:ident) => {
        impl Limits<$float> {
            /// The limits as floats.
            ///
            /// # Panics
            /// At compile time in a constant, with the sentence of the [`Error`] that [`try_new`](Self::try_new)
            /// returns.
            pub const fn new(screening: &Screening, bases: Bases) -> Self {
                or_stop!(Self::try_new(screening, bases))
            }

            /// The limits as floats.
            ///
            /// # Errors
            /// [`Error::Value`] for one that is not positive and finite.
            pub const fn try_new(screening: &Screening, _: Bases) -> Result<Self, Error> {
                let [torque, setpoint, innovation, frozen_turn] = get!(checked(screening));
                Ok(Limits {
                    torque: torque as $float,
                    setpoint: setpoint as $float,
                    innovation: innovation as $float,
                    frozen_turn: frozen_turn as $float,
                    max_coast: screening.max_coast,
                })
            }
        }
    };
}

float!(f32);
float!(f64);

impl Limits<Fixed> {
    /// The limits in fixed point.
    ///
    /// # Panics
    /// At compile time in a constant, with the sentence of the [`Error`] that [`try_new`](Self::try_new) returns.
    pub const fn new(screening: &Screening, bases: Bases) -> Self {
        or_stop!(Self::try_new(screening, bases))
    }

    /// The limits in fixed point.
    ///
    /// # Errors
    /// [`Error::Value`] for one that its base leaves no room for.
    pub const fn try_new(screening: &Screening, bases: Bases) -> Result<Self, Error> {
        get!(bases.check());
        let [torque, setpoint, innovation, frozen_turn] = get!(checked(screening));
        if innovation > INNOVATION_RANGE {
            return Err(Error::Value(INNOVATION));
        }
        if frozen_turn > INNOVATION_RANGE {
            return Err(Error::Value(STANDSTILL));
        }
        Ok(Limits {
            torque: get!(per_unit(torque / bases.torque, TORQUE)),
            setpoint: get!(per_unit(setpoint / bases.speed, SETPOINT)),
            innovation: Fixed::from_bits(innovation as i32),
            frozen_turn: Fixed::from_bits(frozen_turn as i32 >> TURN_SHIFT),
            max_coast: screening.max_coast,
        })
    }
}
