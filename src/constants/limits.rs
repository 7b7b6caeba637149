//! Limits of what a sample can be.

use super::convert::{get, or_stop, per_unit};
use super::format::ANGLE_PER_RADIAN;
use super::{Bases, Error};
use crate::drive::Limits;
use crate::number::{Fixed, INNOVATION_RANGE, TURN_SHIFT};

const TORQUE: &str = "the largest believable torque is beyond twice the base of the torque";
const REFERENCE: &str = "the largest believable set point is beyond twice the base of the speed";
const INNOVATION: &str =
    "the largest believable innovation must be positive and at most 5.6 degrees (0.098 rad) in fixed point";

/// How samples are screened, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Screening {
    /// Largest applied torque that is believed [N m].
    pub torque: f64,
    /// Largest set point that is believed [rad/s].
    pub reference: f64,
    /// Largest innovation that is believed \[rad\]: what the largest torque can do to the motor before the observer has
    /// followed, and no more than 0.098 rad in fixed point.
    pub innovation: f64,
    /// Largest predicted turn in a tick that an unchanged angle is believed with \[rad\]: two counts of the encoder.
    pub standstill: f64,
    /// Ticks in a row without a usable angle after which it counts as lost.
    pub missed: u32,
}

impl Limits<f64> {
    /// The limits in `f64`.
    pub const fn new(screening: &Screening) -> Self {
        Limits {
            torque: screening.torque,
            reference: screening.reference,
            innovation: screening.innovation * ANGLE_PER_RADIAN,
            standstill: screening.standstill * ANGLE_PER_RADIAN,
            missed: screening.missed,
        }
    }
}

impl Limits<f32> {
    /// The limits in `f32`.
    pub const fn new(screening: &Screening) -> Self {
        let limits = Limits::<f64>::new(screening);
        Limits {
            torque: limits.torque as f32,
            reference: limits.reference as f32,
            innovation: limits.innovation as f32,
            standstill: limits.standstill as f32,
            missed: limits.missed,
        }
    }
}

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
        let innovation = screening.innovation * ANGLE_PER_RADIAN;
        let standstill = screening.standstill * ANGLE_PER_RADIAN;
        // Comparisons that a NaN fails.
        if !(innovation > 0.0 && innovation <= INNOVATION_RANGE && standstill <= INNOVATION_RANGE) {
            return Err(Error::Value(INNOVATION));
        }
        Ok(Limits {
            torque: get!(per_unit(screening.torque / bases.torque, TORQUE)),
            reference: get!(per_unit(screening.reference / bases.speed, REFERENCE)),
            innovation: Fixed::from_bits(innovation as i32),
            standstill: Fixed::from_bits(standstill as i32 >> TURN_SHIFT),
            missed: screening.missed,
        })
    }
}
