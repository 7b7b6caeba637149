//! Constants of the composed governor's parts.

use super::constants::constants;
use super::convert::fixed;
use super::format::ANGLE_PER_RADIAN;
use super::{Bases, Error, Format, SpeedLoopSettings};
use crate::configure::Rating;
use crate::design::{GovernorDesign, SpeedLoopDesign};
use crate::governor::{
    AccelerationFeedbackConfig, ActiveDampingConfig, DroopConfig, FeedForwardConfig, Gains, MovingAverageConfig,
    SequencerConfig, SpeedRange, SymmetricLimitConfig, TorqueRangeConfig, TransportDelayConfig,
};
use crate::number::Fixed;

pub(super) const GAIN: &str =
    "a gain of the governor is beyond the range of its number: lower its bandwidth or raise the base of the torque";
const NO_GAIN: &str = "the gains of the governor must be finite, the proportional one above zero, the integral one \
    zero or above, and the period of a tick positive";
pub(super) const RAMP: &str = "the ramp of the governor must be positive and finite, and within a tick at most twice \
    the base of the speed, in fixed point at least 2^-28 of it";
const DROOP: &str = "the droop must be zero or above and finite, for a rated speed and torque above zero, and below \
    half a base of the speed per base of the torque in fixed point";
const FAST_DROOP: &str = "the droop settles within four ticks (droop times k_i T is above 1/4): lower the droop or the \
    bandwidth, or raise the rate";
const SHARE: &str = "the share of the load torque that is fed forward must be from 0 to 1";
pub(super) const LIMIT: &str = "the torque limit of the governor must be positive and finite, its least zero or below, \
    and both within the base of the torque in fixed point, and the limit at least 1/8192 of it: lower the base";
const DRIFT: &str = "the rounding of fixed point would move the integral by more than 1 % of the torque limit in 400 \
    ticks: lower the bandwidth, raise the torque limit, or take f32";
const MODES: &str = "the speeds of the sequencer must be standstill < underspeed < overspeed, none of them negative, \
    the shaft's torque positive, all finite and within twice their bases in fixed point";
const TIMES: &str =
    "the times of sequencer and starter must be zero or above and below 2^31 ticks, and the period of a tick positive";
const ACCELERATION: &str = "the acceleration feedback must be zero or above and finite, and less than twice the torque \
    that accelerates the load in fixed point: lower its share";
const DELAY: &str = "the transport delay must be zero or above and less than its ring of ticks";

/// The limits of [`Sequencer`](crate::governor::Sequencer), in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SequencerSettings {
    /// Overspeed limit (rad/s).
    pub overspeed: f64,
    /// Underspeed limit of a running machine (rad/s); below zero for a machine that runs both ways, which has none.
    pub underspeed: f64,
    /// Largest speed backwards (rad/s); the overspeed limit for a machine that runs both ways.
    pub reverse: f64,
    /// Largest torque of the shaft, either way (N m).
    pub shaft_torque: f64,
    /// The speed below which a braking machine has stopped (rad/s).
    pub standstill: f64,
    /// Time beyond a limit, other than underspeed's, that does not trip yet (s).
    pub trip_delay: f64,
    /// Time of underspeed that does not trip yet (s).
    pub underspeed_delay: f64,
    /// Time that a start may take (s).
    pub start: f64,
}

impl SequencerSettings {
    /// Usual limits of a machine that turns one way: overspeed at 110 %, underspeed at 80 % for 3 s, 2 % backwards and
    /// three times the rated torque in the shaft for 10 ms, standstill below 1 %, and 30 s for a start.
    #[must_use]
    pub const fn of(rating: &Rating) -> Self {
        let (speed, torque) = (rating.speed.0, rating.torque.0);
        Self {
            overspeed: 1.1 * speed,
            underspeed: 0.8 * speed,
            reverse: 0.02 * speed,
            shaft_torque: 3.0 * torque,
            standstill: 0.01 * speed,
            trip_delay: 0.01,
            underspeed_delay: 3.0,
            start: 30.0,
        }
    }
}

pub(super) const fn all_finite(values: &[f64]) -> bool {
    each!(k, 0..values.len(), {
        if !(values[k] as f32).is_finite() {
            return false;
        }
    });
    true
}

/// Gain on the error, on the twist rate, and reset of a proportional and integral law, scaled to a format.
pub(super) const fn law(
    proportional: f64,
    integral: f64,
    damping: f64,
    period: f64,
    format: &Format,
) -> Result<[f64; 3], Error> {
    let Bases { torque, speed, .. } = format.bases;
    let scale = speed / (torque * format.gain);
    let gain = proportional + integral * period;
    let law = [gain * scale, -damping * scale, integral * period / gain];
    if !damps_within_base(damping, format) {
        Err(Error::Coefficient(GAIN))
    } else if proportional > 0.0 && integral >= 0.0 && period > 0.0 && all_finite(&law) {
        Ok(law)
    } else {
        Err(Error::Coefficient(NO_GAIN))
    }
}

/// Whether the damping is within the base of the torque at a twist rate that is not reported: within its base, and
/// within twice that of the speed.
const fn damps_within_base(damping: f64, format: &Format) -> bool {
    let Bases { torque, speed, twist_rate, .. } = format.bases;
    format.unit == 1.0 || damping.abs() * twist_rate.min(2.0 * speed) <= torque
}

/// The base of the torque over the least torque limit in fixed point: as far as the bases of a rating may be doubled.
pub(super) const LEAST_LIMIT: f64 = 8192.0;

/// Checks that in fixed point the integral moves by at most 1 % of a torque limit in 400 ticks by a turn that is wrong
/// by half a unit of its factor, at the base of the speed.
pub(super) const fn holds(integral: f64, limit: f64, format: &Format) -> Result<(), Error> {
    let turn = format.turn / (16.0 * ANGLE_PER_RADIAN);
    if format.unit == 1.0 || 400.0 * integral * turn <= 0.01 * limit { Ok(()) } else { Err(Error::Value(DRIFT)) }
}

/// A torque per unit that leaves the sum of a governor its headroom: the damping is within a base, the integral within
/// two, the proportional part within four.
pub(super) const fn within_base(torque: f64, format: &Format, sentence: &'static str) -> Result<f64, Error> {
    if format.unit != 1.0 && !(torque.abs() <= 1.0) { Err(Error::Value(sentence)) } else { Ok(torque) }
}

/// Gain on the error, reset and step of the ramp.
const fn gains(
    proportional: f64,
    integral: f64,
    period: f64,
    settings: SpeedLoopSettings,
    format: &Format,
) -> Result<([f64; 2], f64), Error> {
    let SpeedLoopSettings { torque_limit, ramp } = settings;
    let step = get!(step(ramp, period, format.bases.speed, format, RAMP));
    let [gain, _, reset] = get!(law(proportional, integral, 0.0, period, format));
    if !(torque_limit > 0.0 && torque_limit.is_finite()) {
        return Err(Error::Value(LIMIT));
    }
    get!(holds(integral, torque_limit, format));
    Ok(([gain, reset], step))
}

/// The least step of a ramp that is not zero, in units of the format.
const fn least_step(format: &Format) -> f64 {
    if format.unit == 1.0 { f32::MIN_POSITIVE as f64 } else { 1.0 }
}

/// The step of a tick at a rate, per unit of a base: one that rounds to zero would hold what follows it.
pub(super) const fn step(
    rate: f64,
    period: f64,
    base: f64,
    format: &Format,
    sentence: &'static str,
) -> Result<f64, Error> {
    let step = rate * period / base;
    if step * format.unit >= least_step(format) && all_finite(&[step]) { Ok(step) } else { Err(Error::Value(sentence)) }
}

pub(super) const fn between(min: f64, max: f64, format: &Format) -> Result<[f64; 2], Error> {
    let torque = format.bases.torque;
    let least = if format.unit == 1.0 { least_step(format) } else { format.unit / LEAST_LIMIT };
    if min <= 0.0 && max / torque * format.unit >= least && all_finite(&[min, max]) {
        Ok([get!(within_base(min / torque, format, LIMIT)), get!(within_base(max / torque, format, LIMIT))])
    } else {
        Err(Error::Value(LIMIT))
    }
}

/// Middle and half width of the running and of the allowed speeds, shaft torque, standstill.
const fn windows(settings: &SequencerSettings, format: &Format) -> Result<[f64; 6], Error> {
    let SequencerSettings { overspeed, underspeed, reverse, shaft_torque, standstill, .. } = *settings;
    let both_ways = underspeed < 0.0;
    let ordered = standstill > 0.0 && (both_ways || standstill < underspeed && underspeed < overspeed);
    let positive = overspeed > standstill && reverse >= 0.0 && shaft_torque > 0.0;
    if !(ordered && positive && all_finite(&[overspeed, underspeed, reverse, shaft_torque])) {
        return Err(Error::Value(MODES));
    }
    let speed = format.bases.speed;
    let lowest = if both_ways { -reverse } else { underspeed };
    Ok([
        0.5 * (lowest + overspeed) / speed,
        0.5 * (overspeed - lowest) / speed,
        0.5 * (overspeed - reverse) / speed,
        0.5 * (overspeed + reverse) / speed,
        shaft_torque / format.bases.torque,
        standstill / speed,
    ])
}

pub(super) const fn ticks(time: f64, period: f64) -> Result<u32, Error> {
    let ticks = time / period + 0.5;
    if time >= 0.0 && period > 0.0 && ticks < 2_147_483_648.0 { Ok(ticks as u32) } else { Err(Error::Value(TIMES)) }
}

constants! {
    /// Gains below the torque limit of the governor's own limit.
    ///
    /// [`Error::Value`] for a ramp that is not positive and finite, or that the number rounds to none, for a torque
    /// limit that is not positive and finite, and for an integral that the rounding of fixed point moves by more than
    /// 1 % of it in 400 ticks; [`Error::Coefficient`] for a gain that is not finite or beyond fixed point.
    impl[] Gains[], new, try_new(design: &GovernorDesign, settings: SpeedLoopSettings), |format| {
        let GovernorDesign { proportional, integral, period, .. } = *design;
        let (law, ramp) = get!(gains(proportional, integral, period, settings, &format));
        let [proportional, reset] = get!(To::coefficients(law, GAIN));
        Ok(Gains { proportional, reset, ramp: get!(To::number(ramp, GAIN)) })
    }

    /// Droop under the gains of a governor, whose integral gain is k_i T in a tick (N m s/rad): by itself the integral
    /// then decays by the factor 1 - R k_i T a tick.
    ///
    /// [`Error`] for a droop (a fraction of the rated speed (rad/s) at the rated torque (N m)) that is out of range,
    /// or where R k_i T is above 1/4. A faster droop turns against every step of a slew limit and amplifies its
    /// rounding; beyond 2 it grows by itself.
    impl[] DroopConfig[], new, try_new(
        fraction: f64, rated_speed: f64, rated_torque: f64, integral: f64
    ), |format| {
        let slope = fraction * rated_speed / rated_torque;
        let droop = slope * format.bases.torque / format.bases.speed;
        if !(fraction >= 0.0 && rated_speed > 0.0 && rated_torque > 0.0 && all_finite(&[droop])) {
            return Err(Error::Value(DROOP));
        }
        if !(integral >= 0.0 && slope * integral <= 0.25) {
            return Err(Error::Value(FAST_DROOP));
        }
        Ok(DroopConfig { droop: get!(To::coefficient(droop, DROOP)) })
    }

    /// [`Error::Value`] for a share that is not from 0 to 1.
    impl[] FeedForwardConfig[], new, try_new(share: f64), |format| {
        if !(share >= 0.0 && share <= 1.0) {
            return Err(Error::Value(SHARE));
        }
        Ok(FeedForwardConfig { share: get!(To::coefficient(share / format.widened, SHARE)) })
    }

    /// [`Error`] for a feedback that is negative or not finite, or in fixed point of twice the torque that
    /// accelerates the load or more.
    impl[] AccelerationFeedbackConfig[], new, try_new(design: &GovernorDesign), |format| {
        if !(design.acceleration >= 0.0 && all_finite(&[design.acceleration])) {
            return Err(Error::Value(ACCELERATION));
        }
        let feedback = get!(To::coefficient(-design.acceleration / format.widened, ACCELERATION));
        Ok(AccelerationFeedbackConfig { feedback })
    }

    /// [`Error::Coefficient`] for a gain that is not finite, or beyond fixed point.
    impl[] ActiveDampingConfig[], new, try_new(design: &SpeedLoopDesign), |format| {
        let damping = -design.damping * format.bases.speed / (format.bases.torque * format.gain);
        if !damps_within_base(design.damping, &format) {
            return Err(Error::Coefficient(GAIN));
        }
        if !all_finite(&[damping]) {
            return Err(Error::Coefficient(NO_GAIN));
        }
        Ok(ActiveDampingConfig { damping: get!(To::coefficient(damping, GAIN)) })
    }

    /// [`Error::Value`] for a torque (N m) that is not positive and finite, or beyond its base.
    impl[] SymmetricLimitConfig[], new, try_new(torque: f64), |format| {
        let [_, torque] = get!(between(0.0, torque, &format));
        Ok(SymmetricLimitConfig { torque: get!(To::number(torque, LIMIT)) })
    }

    /// [`Error::Value`] for torques (N m) that are not at most and above zero and finite, or beyond their base.
    impl[] TorqueRangeConfig[], new, try_new(min: f64, max: f64), |format| {
        let [min, max] = get!(To::numbers(get!(between(min, max, &format)), LIMIT));
        Ok(TorqueRangeConfig { min, max })
    }

    /// [`Error::Value`] for limits out of order or beyond their bases, or a time of 2^31 ticks of `period` (s) or
    /// more.
    impl[] SequencerConfig[], new, try_new(settings: &SequencerSettings, period: f64), |format| {
        let windows = get!(windows(settings, &format));
        let [middle, half, centre, reach, shaft, standstill] = get!(To::numbers(windows, MODES));
        Ok(SequencerConfig {
            running: SpeedRange { middle, half },
            allowed: SpeedRange { middle: centre, half: reach },
            shaft_torque: shaft,
            standstill,
            trip_delay: get!(ticks(settings.trip_delay, period)),
            underspeed_delay: get!(ticks(settings.underspeed_delay, period)),
            start: get!(ticks(settings.start, period)),
        })
    }

    /// Gains of a speed loop, as [`try_new`](Self::try_new) makes those of a governor.
    impl[] Gains[], of_speed_loop, try_of_speed_loop(design: &SpeedLoopDesign, settings: SpeedLoopSettings), |format| {
        let SpeedLoopDesign { proportional, integral, period, .. } = *design;
        let (law, ramp) = get!(gains(proportional, integral, period, settings, &format));
        let [proportional, reset] = get!(To::coefficients(law, GAIN));
        Ok(Gains { proportional, reset, ramp: get!(To::number(ramp, GAIN)) })
    }
}

impl<const K: usize> TransportDelayConfig<K> {
    stops! {
        /// A delay (s) in ticks of `period` (s).
        pub const fn new(delay: f64, period: f64) -> Self = try_new
    }

    /// A delay (s) in ticks of `period` (s), to the nearest.
    ///
    /// # Errors
    /// [`Error::Value`] for a delay that is negative or does not fit the ring.
    pub const fn try_new(delay: f64, period: f64) -> Result<Self, Error> {
        let ticks = match ticks(delay, period) {
            Ok(ticks) => ticks,
            Err(_) => return Err(Error::Value(DELAY)),
        };
        if (ticks as usize) < K { Ok(TransportDelayConfig { ticks }) } else { Err(Error::Value(DELAY)) }
    }
}

impl<const K: usize> MovingAverageConfig<f32, K> {
    /// The constants of a mean over `K` ticks, as floats.
    pub const fn of_ticks() -> Self {
        MovingAverageConfig { share: 1.0 / K as f32 }
    }
}

impl<const K: usize> MovingAverageConfig<f64, K> {
    /// The constants of a mean over `K` ticks, as floats.
    pub const fn of_ticks() -> Self {
        MovingAverageConfig { share: 1.0 / K as f64 }
    }
}

impl<const K: usize> MovingAverageConfig<Fixed, K> {
    /// The constants in fixed point.
    ///
    /// # Panics
    /// At compile time in a constant, for a mean over two ticks or one.
    pub const fn of_ticks() -> Self {
        let [share] = or_stop!(fixed([1.0 / K as f64], GAIN));
        MovingAverageConfig { share }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each product is finite in `f32`, where its factors are.
    #[test]
    fn gains_are_finite() {
        let format = Format { bases: Bases { torque: 1e-20, ..Bases::SI }, ..Format::FLOAT };
        for (proportional, integral, damping, period, is_right) in [
            (1e18, 0.0, 0.0, 1.0, true),
            (1e20, 0.0, 0.0, 1.0, false),
            (1.0, 0.0, 1e18, 1.0, true),
            (1.0, 0.0, -1e20, 1.0, false),
            (1.0, 1e9, 0.0, 1e9, true),
            (1.0, 1e10, 0.0, 1e10, false),
        ] {
            let law = law(proportional, integral, damping, period, &format);
            assert_eq!(law.err(), (!is_right).then_some(Error::Coefficient(NO_GAIN)), "{proportional} {integral}");
        }
    }

    /// To the nearest tick, below 2^31 of them.
    #[test]
    fn limits_of_times() {
        assert_eq!([ticks(0.0, 1.0).ok(), ticks(1.4, 1.0).ok(), ticks(1.5, 1.0).ok()], [Some(0), Some(1), Some(2)]);
        assert_eq!(ticks(2_147_483_647.4, 1.0).ok(), Some(2_147_483_647));
        for (time, period) in [(2_147_483_647.5, 1.0), (-0.1, 1.0), (1.0, 0.0), (0.0, 0.0), (f64::NAN, 1.0)] {
            assert_eq!(ticks(time, period), Err(Error::Value(TIMES)), "{time} {period}");
        }
    }
}
