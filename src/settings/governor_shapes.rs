//! Constants of the governor's parts that are shapes: barred ranges, torque curves, the slew round another limit, and
//! the input shaper round a governor.

use super::constants::constants;
use super::governor_parts::{LIMIT, RAMP, between, step};
use super::{Bases, Error, Format};
use crate::design::{BarredSpeeds, InputShaperDesign, TorqueCurve};
use crate::governor::{BarredConfig, CurveConfig, CurvePiece, InputShaperConfig, SlewConfig, SpeedRange};

const SLEW: &str =
    "the slew of the torque must be positive and finite, and within a tick at most twice the base of the torque";
const CURVE: &str = "the torque curve and its slopes must be finite; in fixed point it must lie within twice the \
    bases, and its slopes within 2 bases of the torque per base of the speed";
const SHAPER: &str = "the input shaper's slots must be whole ticks within 2 % of the delay, below 2^31 ticks, \
    and its share above 0 and at most 1/2: take fewer slots or raise the rate";
const BARRED: &str = "the barred ranges must be as many as the governor has and lie within twice the base of the speed";

/// Speed and torque of a point, and the slope to the next.
const fn piece<const K: usize>(curve: &TorqueCurve<K>, k: usize, format: &Format) -> ([f64; 2], f64) {
    let points = curve.points();
    let Bases { torque, speed, .. } = format.bases;
    let [at, most] = points[k];
    let slope = if k + 1 < K {
        let [next, then] = points[k + 1];
        (then - most) / (next - at)
    } else {
        0.0
    };
    ([at / speed, most / torque], slope * speed / (torque * format.widened))
}

constants! {
    /// [`Error::Value`] for other than `K` ranges, one beyond twice the base of the speed, or a quick ramp (rad/s2)
    /// that is not positive and finite.
    impl[const K: usize] BarredConfig[, K],
    new, try_new(barred: &BarredSpeeds<K>, quick_ramp: f64, period: f64), |format| {
        let quick = get!(To::number(get!(step(quick_ramp, period, format.bases.speed, &format, RAMP)), RAMP));
        let [middle, half] = get!(To::numbers([0.0; 2], BARRED));
        let mut ranges = [SpeedRange { middle, half }; K];
        if barred.ranges().len() < K {
            return Err(Error::Value(BARRED));
        }
        each!(k, 0..K, {
            let ([low, high], speed) = (barred.ranges()[k], format.bases.speed);
            let [middle, half] = get!(To::numbers([0.5 * (low + high) / speed, 0.5 * (high - low) / speed], BARRED));
            ranges[k] = SpeedRange { middle, half };
        });
        Ok(BarredConfig { ranges, quick })
    }

    /// [`Error`] for a smallest torque (N m) above zero or not finite, and a point or a slope that the float does not
    /// hold. Also for a point beyond twice its base, or a slope of 2 bases of the torque per base of the speed or more.
    impl[const K: usize] CurveConfig[, K], new, try_new(curve: &TorqueCurve<K>, min: f64), |format| {
        let [min, _] = get!(To::numbers(get!(between(min, format.bases.torque, &format)), LIMIT));
        let ([speed, torque], slope) = (get!(To::numbers([0.0; 2], CURVE)), get!(To::coefficient(0.0, CURVE)));
        let mut pieces = [CurvePiece { speed, torque, slope }; K];
        each!(k, 0..K, {
            let (point, slope) = piece(curve, k, &format);
            let [speed, torque] = get!(To::numbers(point, CURVE));
            pieces[k] = CurvePiece { speed, torque, slope: get!(To::coefficient(slope, CURVE)) };
        });
        Ok(CurveConfig { pieces, min })
    }

    /// [`Error::Value`] for a torque per time (N m/s) that is not positive and finite, or twice the base of the torque
    /// in a tick.
    impl[L: Copy] SlewConfig[, L], new, try_new(rate: f64, limit: L, period: f64), |format| {
        let step = get!(step(rate, period, format.bases.torque, &format, SLEW));
        Ok(SlewConfig { step: get!(To::number(step, SLEW)), limit })
    }
}

/// Ticks of a slot, and the share of the later part.
const fn shaper(design: &InputShaperDesign, slots: u32, period: f64) -> Result<(u32, f64), Error> {
    match design.slot(slots, period) {
        // a coefficient in fixed point ends at 1/2 less 2^-32
        Some(slot) if design.share > 0.0 && design.share <= 0.5 => {
            Ok((slot, design.share.min(0.5 - 0.25 / 1_073_741_824.0)))
        }
        _ => Err(Error::Value(SHAPER)),
    }
}

constants! {
    /// [`Error::Value`] for a ramp (rad/s2) that is not positive and finite, or slots, so many between two parts, of
    /// less than a tick.
    impl[C: Copy] InputShaperConfig[, C],
    new, try_new(design: &InputShaperDesign, slots: u32, ramp: f64, governor: C, period: f64), |format| {
        let (slot, share) = get!(shaper(design, slots, period));
        let ramp = get!(To::number(get!(step(ramp, period, format.bases.speed, &format, RAMP)), RAMP));
        Ok(InputShaperConfig { ramp, slot, share: get!(To::coefficient(share, SHAPER)), governor })
    }
}
