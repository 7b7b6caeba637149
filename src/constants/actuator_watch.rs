//! Constants of the watch on an actuator.

use super::convert::{get, or_stop};
use super::governor_parts::{Values, all_finite, in_fixed, ticks};
use super::{Bases, Error, Format};
use crate::governor::ActuatorWatchConfig;
use crate::number::{Coefficient, Fixed};
use crate::scalar::exp_m1;

const WATCH: &str = "the watch on an actuator needs a tolerance below the largest torque, both positive, finite and within twice the base of the torque in fixed point";
const LAG: &str = "a lag of an actuator that is watched must be positive and finite, in fixed point over 1.5 ticks";

/// When an actuator counts as lost, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ActuatorWatchSettings {
    /// Largest difference of the position's torque from the one that is expected \[N m\]: more than a step of the largest torque
    /// makes of what the lags are not known to, about 0.4 of it times their relative error.
    pub tolerance: f64,
    /// Largest torque that the actuator can stand for \[N m\].
    pub most: f64,
    /// How long a larger difference is ridden through \[s\].
    pub patience: f64,
}

const fn torques(settings: &ActuatorWatchSettings, format: &Format) -> Values<2, 0> {
    let ActuatorWatchSettings { tolerance, most, .. } = *settings;
    let per_unit = tolerance / format.bases.torque;
    // A tolerance that the number rounds to zero would believe no position.
    let told = if format.unit == 1.0 { per_unit as f32 > 0.0 } else { per_unit * format.unit >= 1.0 };
    if told && most > tolerance && all_finite(&[tolerance, most]) {
        Ok(([per_unit, most / format.bases.torque], []))
    } else {
        Err(Error::Value(WATCH))
    }
}

/// What a lag covers of its way in a tick.
const fn covered(lag: f64, period: f64) -> Result<f64, Error> {
    if lag > 0.0 && lag.is_finite() { Ok(-exp_m1(-period / lag)) } else { Err(Error::Value(LAG)) }
}

macro_rules! float {
    ($float:ident) => {
        impl<const K: usize> ActuatorWatchConfig<$float, K> {
            /// The constants as floats: the actuator's lags in a row \[s\], and the period of a tick \[s\].
            ///
            /// # Panics
            /// At compile time in a constant, with the sentence of the [`Error`] that [`try_new`](Self::try_new)
            /// returns.
            pub const fn new(lags: &[f64; K], settings: &ActuatorWatchSettings, period: f64, bases: Bases) -> Self {
                or_stop!(Self::try_new(lags, settings, period, bases))
            }

            /// The constants as floats.
            ///
            /// # Errors
            /// [`Error::Value`] for a torque or a lag that is not positive and finite, a tolerance of the largest torque or more, a
            /// patience of 2^31 ticks or more.
            pub const fn try_new(
                lags: &[f64; K],
                settings: &ActuatorWatchSettings,
                period: f64,
                _: Bases,
            ) -> Result<Self, Error> {
                let ([tolerance, most], []) = get!(torques(settings, &Format::FLOAT));
                let patient = get!(ticks(settings.patience, period));
                let mut share = [0.0; K];
                let mut k = 0;
                while k < K {
                    share[k] = get!(covered(lags[k], period)) as $float;
                    k += 1;
                }
                Ok(ActuatorWatchConfig { share, tolerance: tolerance as $float, most: most as $float, patient })
            }
        }
    };
}

float!(f32);
float!(f64);

impl<const K: usize> ActuatorWatchConfig<Fixed, K> {
    /// The constants in fixed point: the actuator's lags in a row \[s\], and the period of a tick \[s\].
    ///
    /// # Panics
    /// At compile time in a constant, with the sentence of the [`Error`] that [`try_new`](Self::try_new) returns.
    pub const fn new(lags: &[f64; K], settings: &ActuatorWatchSettings, period: f64, bases: Bases) -> Self {
        or_stop!(Self::try_new(lags, settings, period, bases))
    }

    /// The constants in fixed point.
    ///
    /// # Errors
    /// [`Error::Value`] as for floats, for a lag of 1.44 ticks or less, and for torques beyond twice their base.
    pub const fn try_new(
        lags: &[f64; K],
        settings: &ActuatorWatchSettings,
        period: f64,
        bases: Bases,
    ) -> Result<Self, Error> {
        get!(bases.check());
        let ([tolerance, most], []) = get!(in_fixed(torques(settings, &Format::fixed(bases)), WATCH));
        let patient = get!(ticks(settings.patience, period));
        let mut share = [Coefficient::ZERO; K];
        let mut k = 0;
        while k < K {
            share[k] = match Coefficient::from_f64(get!(covered(lags[k], period))) {
                Some(share) => share,
                None => return Err(Error::Value(LAG)),
            };
            k += 1;
        }
        Ok(ActuatorWatchConfig { share, tolerance, most, patient })
    }
}
