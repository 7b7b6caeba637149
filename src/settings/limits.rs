//! Plausibility limits of a sample.

use super::Error;
use super::constants::constants;
use super::convert::positive;
use super::format::ANGLE_PER_RADIAN;
use crate::drive::Limits;

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
    /// Largest plausible applied torque (N m), below the end of the range of a sensor that reports it: a report at that
    /// end is saturated. A torque at this limit is taken, as the command may be there.
    pub torque: f64,
    /// Largest plausible setpoint (rad/s).
    pub setpoint: f64,
    /// Largest plausible innovation (rad): the motor's deviation under the largest torque before the observer has
    /// followed, at most 0.098 rad in fixed point.
    pub innovation: f64,
    /// Largest predicted turn in a tick for which an unchanged angle is plausible (rad): two counts of the encoder.
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

constants! {
    /// [`Error::Value`] for a limit that is not positive and finite, or that its base leaves no room for.
    impl[] Limits[], new, try_new(screening: &Screening), |format| {
        let [torque, setpoint, innovation, frozen_turn] = get!(checked(screening));
        let (innovation, frozen_turn) =
            (get!(To::angle(innovation, INNOVATION)), get!(To::turn(frozen_turn, STANDSTILL)));
        Ok(Limits {
            torque: get!(To::positive(torque / format.bases.torque, TORQUE)),
            setpoint: get!(To::positive(setpoint / format.bases.speed, SETPOINT)),
            innovation,
            frozen_turn,
            max_coast: screening.max_coast,
        })
    }
}
