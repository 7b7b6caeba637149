//! Constants of the speed loop.

use super::constants::constants;
use super::governor_parts::{GAIN, LEAST_LIMIT, holds, law, within_base};
use super::{Bases, Error};
use crate::design::SpeedLoopDesign;
use crate::governor::{LagConfig, SpeedLoopConfig};
use crate::math::exp_m1;

const TORQUE: &str = "the torque limit of the speed loop must be positive and finite, and at most the base of the \
    torque in fixed point, and at least 1/8192 of it: lower the base";
const RAMP: &str = "the ramp of the speed loop must be positive and finite, and within a tick at most twice the base \
    of the speed in fixed point";

const LAG: &str = "the lag of the damping must be positive and finite, in fixed point over 1.5 ticks: lengthen it or \
    raise the rate";

/// Settings of the speed loop beside its gains.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SpeedLoopSettings {
    /// Largest torque, in either direction (N m).
    pub torque_limit: f64,
    /// Largest acceleration of the setpoint (rad/s2).
    pub ramp: f64,
}

constants! {
    /// [`Error::Coefficient`] for a gain that is not positive and finite, or beyond the range of fixed point;
    /// [`Error::Value`] for a torque limit or a ramp that is not positive and finite, or beyond its base, and for
    /// an integral that the rounding of fixed point moves by more than 1 % of the limit in 400 ticks.
    impl[] SpeedLoopConfig[], new, try_new(design: &SpeedLoopDesign, settings: SpeedLoopSettings), |format| {
        let Bases { torque, speed, .. } = format.bases;
        let SpeedLoopDesign { proportional, integral, damping, period, .. } = *design;
        let [proportional, damping, reset] = get!(law(proportional, integral, damping, period, &format));
        let limit = get!(within_base(settings.torque_limit / torque, &format, TORQUE));
        if format.unit != 1.0 && !(limit * LEAST_LIMIT >= 1.0) {
            return Err(Error::Value(TORQUE));
        }
        let torque_limit = get!(To::positive(limit, TORQUE));
        get!(holds(integral, settings.torque_limit, &format));
        let [proportional, damping, reset] = get!(To::coefficients([proportional, damping, reset], GAIN));
        Ok(SpeedLoopConfig {
            proportional,
            damping,
            reset,
            torque_limit,
            ramp: get!(To::positive(settings.ramp * period / speed, RAMP)),
            filter: (),
        })
    }

    /// [`Error::Value`] for a lag (s) that is not positive and finite, [`Error::Coefficient`] in fixed point for one
    /// of 1.44 ticks of `period` (s) or less.
    impl[] LagConfig[], new, try_new(lag: f64, period: f64), |_format| {
        let share = -exp_m1(-period / lag);
        if !(lag > 0.0 && lag.is_finite() && share > 0.0) {
            return Err(Error::Value(LAG));
        }
        Ok(LagConfig { share: get!(To::coefficient(share, LAG)) })
    }
}
