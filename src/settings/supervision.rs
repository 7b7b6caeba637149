//! Constants of the supervision.

use super::constants::constants;
use super::convert::positive;
use super::format::ANGLE_PER_RADIAN;
use super::governor_parts::ticks;
use super::{Bases, Error};
use crate::design::Supervision;
use crate::governor::{SupervisionConfig, TURN};
use crate::math::exp_m1;

const TORQUE: &str = "the torques of the supervision must be positive and finite, and at most twice the base of the \
    torque in fixed point";
const LOAD: &str = "the least load torque of the supervision must be below the largest one";
const SPEED: &str = "the speeds of the supervision must be positive and finite, and at most twice the base of the \
    speed in fixed point";
const ANGLE: &str =
    "the angles of the supervision must be positive, and at most 5.6 degrees (0.098 rad) in fixed point";
const AVERAGE: &str = "the average of the supervision must be longer than a tick, in fixed point than 1.5 ticks";

constants! {
    /// [`Error::Value`] for a limit that is not positive and finite, or that its base leaves no room for;
    /// [`Error::Coefficient`] for an average that is too short.
    impl[] SupervisionConfig[], new, try_new(limits: &Supervision, period: f64), |format| {
        let Bases { torque, speed, .. } = format.bases;
        let [least, most] = limits.load_torque;
        if !(least < most) {
            return Err(Error::Value(LOAD));
        }
        Ok(SupervisionConfig {
            innovation: get!(To::angle(get!(positive(limits.innovation * ANGLE_PER_RADIAN, ANGLE)), ANGLE)),
            change: get!(To::positive(limits.change / torque, TORQUE)),
            recent: get!(To::coefficient(-exp_m1(-(TURN as f64) * period / limits.recent), AVERAGE)),
            load_torque_middle: get!(To::number(0.5 * (least + most) / torque, TORQUE)),
            load_torque_half: get!(To::positive(0.5 * (most - least) / torque, TORQUE)),
            shaft_torque: get!(To::positive(limits.shaft_torque / torque, TORQUE)),
            speed: get!(To::positive(limits.speed / speed, SPEED)),
            report: get!(To::positive(limits.report / torque, TORQUE)),
            share: get!(To::coefficient(-exp_m1(-(TURN as f64) * period / limits.average), AVERAGE)),
            slip: get!(To::angle(get!(positive(limits.slip * ANGLE_PER_RADIAN, ANGLE)), ANGLE)),
            breakaway: get!(To::positive(limits.breakaway / torque, TORQUE)),
            still: get!(To::positive(limits.still / speed, SPEED)),
            sudden: get!(ticks(limits.sudden, period)) + 3,
            lasting: get!(ticks(limits.lasting, period)),
            naming: get!(ticks(limits.naming, period)),
            stop_torque: get!(To::positive(limits.stop_torque / torque, TORQUE)),
            standstill: get!(To::positive(limits.standstill / speed, SPEED)),
        })
    }
}
