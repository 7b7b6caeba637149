//! Constants of the load sharing of several motors.

use super::Error;
use super::constants::constants;
use super::format::ANGLE_PER_RADIAN;
use crate::governor::LoadSharingConfig;

const TORQUES: &str = "preload, slew and torque limit of a load sharing must be positive and finite, and its limits \
    0 < bias_below < equal_above, twice which and the preload are within the torque limit; in fixed point all within \
    twice the base of the torque";
const DAMPING: &str = "the damping of a load sharing must be zero or above and finite, and in fixed point its torque \
    per angle less than half of its range: damp less, let it lag more, or raise the base of the torque";
const LAG: &str = "the damping of a load sharing needs a lag from one tick to 65,536 of them";
const MOTORS: &str = "a load sharing has an even number of motors, from 2 to 32";
const DEVIATION: &str =
    "the largest plausible deviation of a motor must be positive, and with the number of motors at most half a turn";

/// Settings of a load sharing, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LoadSharingSettings {
    /// Number of motors, even.
    pub motors: u32,
    /// Torque of a motor that holds its flank against the load (N m): more than the estimate's error, the torques'
    /// inaccuracy and what the pinions swing by.
    pub preload: f64,
    /// A motor's share of the shaft torque above which all motors share the load equally (N m): twice this plus the
    /// preload must not exceed the torque limit.
    pub equal_above: f64,
    /// The share below which the motors are biased again (N m).
    pub bias_below: f64,
    /// Largest change of the bias (N m/s): faster than a motor's share of the shaft torque changes, lest a holding
    /// pinion leave its flank.
    pub slew: f64,
    /// Largest torque of a motor, either way (N m).
    pub torque_limit: f64,
    /// Damping of a motor against the mean (N m s/rad).
    pub damping: f64,
    /// Lag of the damping (s): rounded to a power of two of ticks, far less than a period in which the motors swing
    /// against each other.
    pub lag: f64,
    /// Largest plausible deviation of a motor from the first (rad): backlash and twist.
    pub max_deviation: f64,
}

/// Logarithm to the base of two of the ticks of a lag, rounded.
const fn shift(lag: f64, period: f64) -> Result<u32, Error> {
    let ticks = lag / period;
    if !(ticks >= 1.0 && ticks <= 65_536.0) {
        return Err(Error::Value(LAG));
    }
    let mut shift = 0;
    // to the nearest by ratio: 2^(shift + 1/2)
    while ticks > (1_u32 << shift) as f64 * core::f64::consts::SQRT_2 {
        shift += 1;
    }
    Ok(shift)
}

constants! {
    /// [`Error::Value`] for torques, limits, a lag, a number of motors or a deviation out of range;
    /// [`Error::Coefficient`] for a damping out of range.
    impl[] LoadSharingConfig[], new, try_new(settings: &LoadSharingSettings, period: f64), |format| {
        let LoadSharingSettings { motors, preload, equal_above, bias_below, slew, torque_limit, .. } = *settings;
        if !(motors >= 2 && motors <= 32 && motors.is_multiple_of(2)) {
            return Err(Error::Value(MOTORS));
        }
        let carried = 2.0 * equal_above + preload;
        if !(bias_below > 0.0 && bias_below < equal_above && carried <= torque_limit) {
            return Err(Error::Value(TORQUES));
        }
        let deviation = settings.max_deviation * ANGLE_PER_RADIAN;
        if !(deviation >= 1.0 && deviation * motors as f64 <= 2_147_483_647.0) {
            return Err(Error::Value(DEVIATION));
        }
        if !(settings.damping >= 0.0) {
            return Err(Error::Coefficient(DAMPING));
        }
        let base = format.bases.torque;
        let lag = get!(shift(settings.lag, period));
        let per_angle = settings.damping / ((1_u32 << lag) as f64 * period);
        Ok(LoadSharingConfig {
            share: get!(To::coefficient(1.0 / (motors as f64 * format.widened), MOTORS)),
            preload: get!(To::positive(preload / base, TORQUES)),
            equal_above: get!(To::positive(equal_above / base, TORQUES)),
            bias_below: get!(To::positive(bias_below / base, TORQUES)),
            step: get!(To::positive(slew * period / base, TORQUES)),
            torque_limit: get!(To::positive(torque_limit / base, TORQUES)),
            damping: get!(To::coefficient(
                -per_angle * format.unit / (ANGLE_PER_RADIAN * base * format.innovation),
                DAMPING
            )),
            lag,
            max_deviation: deviation as i32,
        })
    }
}
