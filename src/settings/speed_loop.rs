//! Constants of the speed loop.

use super::constants::constants;
use super::convert::get;
use super::{Bases, Error, Format};
use crate::design::SpeedLoopDesign;
use crate::governor::{DampingLagConfig, SpeedLoopConfig};
use crate::math::exp_m1;

const GAIN: &str =
    "a gain of the speed loop is beyond the range of its number: lower its bandwidth or raise the base of the torque";
const TORQUE: &str = "the torque limit of the speed loop must be positive and finite, and at most twice the base of \
    the torque in fixed point";
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

const fn speed_loop(design: &SpeedLoopDesign, settings: &SpeedLoopSettings, format: &Format) -> SpeedLoopConfig<f64> {
    let Bases { torque, speed, .. } = format.bases;
    let scale = speed / (torque * format.gain);
    SpeedLoopConfig {
        proportional: design.proportional * scale,
        integral: design.integral * design.period * scale,
        damping: -design.damping * scale,
        anti_windup: design.integral * design.period / design.proportional,
        torque_limit: settings.torque_limit / torque,
        ramp: settings.ramp * design.period / speed,
        filter: (),
    }
}

constants! {
    /// [`Error::Coefficient`] for a gain beyond the range of fixed point, [`Error::Value`] for a torque limit or a ramp
    /// that is not positive and finite, or beyond its base.
    impl[] SpeedLoopConfig[], new, try_new(design: &SpeedLoopDesign, settings: SpeedLoopSettings), |format| {
        let c = speed_loop(design, &settings, &format);
        let [proportional, integral, damping, anti_windup] =
            get!(To::coefficients([c.proportional, c.integral, c.damping, c.anti_windup], GAIN));
        // Operands are held within 8 bases and the integral within 2: the sum of all must stay within 8.
        if format.unit != 1.0 && 8.0 * (c.proportional.abs() + c.integral.abs() + c.damping.abs()) > 5.99 {
            return Err(Error::Coefficient(GAIN));
        }
        Ok(SpeedLoopConfig {
            proportional,
            integral,
            damping,
            anti_windup,
            torque_limit: get!(To::positive(c.torque_limit, TORQUE)),
            ramp: get!(To::positive(c.ramp, RAMP)),
            filter: (),
        })
    }
}

constants! {
    /// [`Error::Value`] for a lag (s) that is not positive and finite, [`Error::Coefficient`] in fixed point for one
    /// of 1.44 ticks of `period` (s) or less.
    impl[] DampingLagConfig[], new, try_new(lag: f64, period: f64), |_format| {
        let share = -exp_m1(-period / lag);
        if !(lag > 0.0 && lag.is_finite() && share > 0.0) {
            return Err(Error::Value(LAG));
        }
        Ok(DampingLagConfig { share: get!(To::coefficient(share, LAG)) })
    }
}
