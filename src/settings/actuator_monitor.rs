//! Constants of the watch on an actuator.

use super::Error;
use super::constants::constants;
use super::governor_parts::{all_finite, ticks};
use crate::configure::Rating;
use crate::governor::ActuatorMonitorConfig;
use crate::math::exp_m1;

const WATCH: &str = "the actuator monitor needs a tolerance below the largest torque, both positive, finite and \
    within twice the base of the torque in fixed point";
const LAG: &str = "a lag of a monitored actuator must be positive and finite, in fixed point over 1.5 ticks";

/// Settings of the actuator monitor, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ActuatorMonitorSettings {
    /// Largest difference between the position's torque and the expected one (N m): more than 0.4 of the largest
    /// torque times the relative error of the lags.
    pub tolerance: f64,
    /// Largest torque of the actuator (N m).
    pub max_torque: f64,
    /// Duration of a larger difference before a trip (s).
    pub timeout: f64,
}

impl ActuatorMonitorSettings {
    /// Usual limits: a difference of a fifth of the rated torque for 0.1 s, and 1.3 times the torque limit.
    #[must_use]
    pub const fn of(rating: &Rating) -> Self {
        Self { tolerance: 0.2 * rating.torque.0, max_torque: 1.3 * rating.torque_limit.0, timeout: 0.1 }
    }
}

/// Share of a step that a lag covers in a tick.
const fn covered(lag: f64, period: f64) -> Result<f64, Error> {
    if lag > 0.0 && lag.is_finite() { Ok(-exp_m1(-period / lag)) } else { Err(Error::Value(LAG)) }
}

constants! {
    /// [`Error::Value`] for a torque or a lag that is not positive and finite, a tolerance of the largest torque or
    /// more, a timeout of 2^31 ticks or more; in fixed point for a lag of 1.44 ticks or less, and for torques beyond
    /// twice their base.
    impl[const K: usize] ActuatorMonitorConfig[, K],
    new, try_new(lags: &[f64; K], settings: &ActuatorMonitorSettings, period: f64), |format| {
        let ActuatorMonitorSettings { tolerance, max_torque, .. } = *settings;
        let per_unit = tolerance / format.bases.torque;
        // A tolerance that rounds to zero would reject every position.
        let measured = if format.unit == 1.0 { per_unit as f32 > 0.0 } else { per_unit * format.unit >= 1.0 };
        if !(measured && max_torque > tolerance && all_finite(&[tolerance, max_torque])) {
            return Err(Error::Value(WATCH));
        }
        let [tolerance, max_torque] = get!(To::numbers([per_unit, max_torque / format.bases.torque], WATCH));
        let timeout = get!(ticks(settings.timeout, period));
        let mut share = [get!(To::coefficient(0.0, LAG)); K];
        each!(k, 0..K, {
            share[k] = match To::coefficient(get!(covered(lags[k], period)), LAG) {
                Ok(share) => share,
                Err(_) => return Err(Error::Value(LAG)),
            };
        });
        Ok(ActuatorMonitorConfig { share, tolerance, max_torque, timeout })
    }
}
