//! Constants of the governor's parts that are shapes: barred ranges, torque curves, the slew round another limit, and
//! the input shaper round a governor.

use super::constants::constants;
use super::governor_parts::{LIMIT, RAMP, all_finite, between, least_step, ticks};
use super::to::Values;
use super::{Bases, Error, Format};
use crate::design::{BarredSpeeds, InputShaperDesign, TorqueCurve};
use crate::governor::{
    BarredConfig, CurveConfig, CurvePiece, InputShaperConfig, ResistorStarterConfig, SlewConfig, SoftStarterConfig,
    SpeedRange,
};
use crate::machine::{ResistorStart, SoftStart};

const SLEW: &str =
    "the slew of the torque must be positive and finite, and within a tick at most twice the base of the torque";
const CURVE: &str = "the torque curve and its slopes must be finite; in fixed point it must lie within twice the \
    bases, and its slopes within 2 bases of the torque per base of the speed";
const STARTER: &str = "the speeds of a start by resistors must be finite, and within twice the base of the speed";
const SOFT: &str = "the torque limit of a start by reduced voltage must be below twice the base of the torque, and \
    the voltage must rise by 1e-6 to 0.1 of the full one in a tick";
const SHAPER: &str = "the input shaper's slots must be whole ticks within 2 % of the delay, below 2^31 ticks, \
    and its share above 0 and at most 1/2: take fewer slots or raise the rate";
const BARRED: &str = "the barred ranges must be as many as the governor has and lie within twice the base of the speed";

const fn slew(rate: f64, period: f64, format: &Format) -> Values<1, 0> {
    let step = rate * period / format.bases.torque;
    if step * format.unit >= least_step(format) && all_finite(&[step]) {
        Ok(([step], []))
    } else {
        Err(Error::Value(SLEW))
    }
}

/// In a float a millionth of 1 is rounded by 3 %.
const fn soft(start: &SoftStart, period: f64, format: &Format) -> Values<3, 0> {
    let step = (1.0 - start.initial) * period / start.rise;
    let limit = start.peak / format.bases.torque;
    // in fixed point an observed torque ends a unit in the last place below twice its base
    let room = 2.0 * format.unit - 1.5;
    if step >= 1e-6 && step <= 0.1 && (format.widened == 1.0 || limit * format.unit < room) {
        Ok(([start.initial, step, limit], []))
    } else {
        Err(Error::Value(SOFT))
    }
}

const fn piece<const K: usize>(curve: &TorqueCurve<K>, k: usize, format: &Format) -> Values<2, 1> {
    let points = curve.points();
    let Bases { torque, speed, .. } = format.bases;
    let [at, most] = points[k];
    let slope = if k + 1 < K {
        let [next, then] = points[k + 1];
        (then - most) / (next - at)
    } else {
        0.0
    };
    Ok(([at / speed, most / torque], [slope * speed / (torque * format.widened)]))
}

const fn range<const K: usize>(barred: &BarredSpeeds<K>, k: usize, format: &Format) -> Values<2, 0> {
    let ranges = barred.ranges();
    if k >= ranges.len() {
        return Err(Error::Value(BARRED));
    }
    let ([low, high], speed) = (ranges[k], format.bases.speed);
    Ok(([0.5 * (low + high) / speed, 0.5 * (high - low) / speed], []))
}

const fn quick(rate: f64, period: f64, format: &Format) -> Values<1, 0> {
    let step = rate * period / format.bases.speed;
    if step * format.unit >= least_step(format) && all_finite(&[step]) {
        Ok(([step], []))
    } else {
        Err(Error::Value(RAMP))
    }
}

constants! {
    /// [`Error::Value`] for other than `K` ranges, one beyond twice the base of the speed, or a quick ramp (rad/s2)
    /// that is not positive and finite.
    impl[const K: usize] BarredConfig[, K],
    new, try_new(barred: &BarredSpeeds<K>, quick_ramp: f64, period: f64), |format| {
        let ([quick], []) = get!(To::part(quick(quick_ramp, period, &format), RAMP));
        let ([none], []) = get!(To::part(Ok(([0.0], [])), BARRED));
        let mut ranges = [SpeedRange { middle: none, half: none }; K];
        each!(k, 0..K, {
            let ([middle, half], []) = get!(To::part(range(barred, k, &format), BARRED));
            ranges[k] = SpeedRange { middle, half };
        });
        Ok(BarredConfig { ranges, quick })
    }
}

constants! {
    /// [`Error`] for a smallest torque (N m) above zero or not finite, and a point or a slope that the float does not
    /// hold. Also for a point beyond twice its base, or a slope of 2 bases of the torque per base of the speed or more.
    impl[const K: usize] CurveConfig[, K], new, try_new(curve: &TorqueCurve<K>, min: f64), |format| {
        let ([min, _], []) = get!(To::part(between(min, format.bases.torque, &format), LIMIT));
        let ([none], [flat]) = get!(To::part(Ok(([0.0], [0.0])), CURVE));
        let mut pieces = [CurvePiece { speed: none, torque: none, slope: flat }; K];
        each!(k, 0..K, {
            let ([speed, torque], [slope]) = get!(To::part(piece(curve, k, &format), CURVE));
            pieces[k] = CurvePiece { speed, torque, slope };
        });
        Ok(CurveConfig { pieces, min })
    }
}

constants! {
    /// [`Error::Value`] for a time between two resistors (s) below zero or of 2^31 ticks, or a speed beyond twice its
    /// base.
    impl[const STEPS: usize] ResistorStarterConfig[, STEPS],
    new, try_new(start: &ResistorStart<STEPS>, interval: f64, period: f64), |format| {
        let interval = get!(ticks(interval, period));
        let ([none], []) = get!(To::part(Ok(([0.0], [])), STARTER));
        let mut speeds = [none; STEPS];
        each!(k, 0..STEPS, {
            let ([speed], []) = get!(To::part(Ok(([start.speeds[k] / format.bases.speed], [])), STARTER));
            speeds[k] = speed;
        });
        Ok(ResistorStarterConfig { speeds, interval })
    }
}

constants! {
    /// [`Error::Value`] for a torque limit beyond twice its base, or a voltage that rises in a tick by less than
    /// 1e-6 or more than 0.1 of the full one.
    impl[] SoftStarterConfig[], new, try_new(start: &SoftStart, period: f64), |format| {
        let ([initial, step, limit], []) = get!(To::part(soft(start, period, &format), SOFT));
        Ok(SoftStarterConfig { initial, step, limit })
    }
}

constants! {
    /// [`Error::Value`] for a torque per time (N m/s) that is not positive and finite, or twice the base of the torque
    /// in a tick.
    impl[L: Copy] SlewConfig[, L], new, try_new(rate: f64, limit: L, period: f64), |format| {
        let ([step], []) = get!(To::part(slew(rate, period, &format), SLEW));
        Ok(SlewConfig { step, limit })
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
        let ([ramp], []) = get!(To::part(quick(ramp, period, &format), RAMP));
        Ok(InputShaperConfig { ramp, slot, share: get!(To::coefficient(share, SHAPER)), governor })
    }
}
