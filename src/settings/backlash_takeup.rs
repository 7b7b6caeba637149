//! Constants of backlash take-up.

use super::constants::constants;
use super::convert::positive;
use super::{Bases, Error, Format};
use crate::design::BacklashTakeUpDesign;
use crate::governor::BacklashTakeUpConfig;

const GAIN: &str = "a gain of the backlash take-up is beyond the range of its number: let its impact be larger, \
    damp less, or raise the base of the torque";
const TORQUE: &str = "torque, rise and largest torque of the backlash take-up must be positive and finite, and at most \
    twice the base of the torque in fixed point";
const PROPORTIONAL: &str = "the proportional gain of the governor with a backlash take-up must be positive and finite: \
    its ramp is held back by torque over this gain";

/// Torque, step, fall, most, braking, damping and tracking, scaled to a format.
const fn take_up(design: &BacklashTakeUpDesign, proportional: f64, format: &Format) -> [f64; 7] {
    let Bases { torque, speed, .. } = format.bases;
    let scale = speed / (torque * format.gain);
    [
        design.torque / torque,
        design.slew * design.period / torque,
        design.fall * design.period / torque,
        design.max_torque / torque,
        -design.braking * scale,
        -design.damping * scale,
        torque / (speed * proportional * format.widened),
    ]
}

constants! {
    /// [`Error::Coefficient`] for a gain beyond the range of fixed point, [`Error::Value`] for a figure that is not
    /// positive and finite, or beyond its base. `proportional` is the governor's gain k_p (N m s/rad), for the tracking
    /// of its ramp.
    impl[L: Copy] BacklashTakeUpConfig[, L], new,
    try_new(design: &BacklashTakeUpDesign, proportional: f64, limit: L), |format| {
        get!(positive(proportional, PROPORTIONAL));
        let [torque, step, fall, max_torque, braking, damping, tracking] = take_up(design, proportional, &format);
        // Operands are held within 8 bases: with a torque of twice its base beside them the sum must stay within 8.
        if format.unit != 1.0 && (8.0 * -braking > 5.99 || 8.0 * -damping > 5.99) {
            return Err(Error::Coefficient(GAIN));
        }
        let [braking, damping, tracking] = get!(To::coefficients([braking, damping, tracking], GAIN));
        Ok(BacklashTakeUpConfig {
            torque: get!(To::positive(torque, TORQUE)),
            braking,
            step: get!(To::positive(step, TORQUE)),
            fall: get!(To::number(-get!(positive(fall, TORQUE)), TORQUE)),
            max_torque: get!(To::positive(max_torque, TORQUE)),
            damping,
            tracking,
            limit,
        })
    }
}
