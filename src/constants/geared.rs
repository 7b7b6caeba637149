//! Constants of a gear's loss.

use super::convert::{fixed, get, or_stop};
use super::{Bases, Error, Format};
use crate::machine::Efficiency;
use crate::number::Fixed;
use crate::observer::GearedConfig;

const EFFICIENCY: &str = "the efficiency of the gear must be above 0 and at most 1";
const INERTIA: &str = "the inertia in front of the gear and the period must be positive and finite";
const FIXED: &str = "the efficiency of the gear must be above 0.62 in fixed point";

/// Friction per shaft torque, and what brings the motor to rest within two ticks, scaled to a format.
const fn losses(efficiency: Efficiency, motor_inertia: f64, period: f64, format: &Format) -> Result<[f64; 2], Error> {
    let eta = efficiency.0;
    if !(eta > 0.0 && eta <= 1.0) {
        return Err(Error::Value(EFFICIENCY));
    }
    let stiction = 0.5 * motor_inertia / period;
    if !(stiction > 0.0 && stiction.is_finite()) {
        return Err(Error::Value(INERTIA));
    }
    let Bases { torque, speed, .. } = format.bases;
    let scaled = stiction * (speed / torque) / format.gain;
    // Fixed point holds no more than 16 per unit; a softer hold brings the motor to rest within more ticks.
    let limit = if format.gain == 1.0 { f64::INFINITY } else { 0.499 };
    let held = if scaled < limit { scaled } else { limit };
    Ok([0.5 * ((1.0 / eta - 1.0) + (1.0 - eta)), held])
}

macro_rules! float {
    ($float:ident) => {
        impl<C: Copy> GearedConfig<$float, C> {
            /// An observer's constants behind a gear of this efficiency, driven by this inertia [kg m2] in ticks of this period \[s\].
            ///
            /// # Panics
            /// At compile time in a constant, with the sentence of the [`Error`] that [`try_new`](Self::try_new) returns.
            pub const fn new(observer: C, efficiency: Efficiency, motor_inertia: f64, period: f64) -> Self {
                or_stop!(Self::try_new(observer, efficiency, motor_inertia, period))
            }

            /// An observer's constants behind a gear of this efficiency, driven by this inertia [kg m2] in ticks of this period \[s\].
            ///
            /// # Errors
            /// [`Error::Value`] for an efficiency that is not above 0 and at most 1, or an inertia or period that is not positive.
            pub const fn try_new(
                observer: C,
                efficiency: Efficiency,
                motor_inertia: f64,
                period: f64,
            ) -> Result<Self, Error> {
                let [friction, stiction] = get!(losses(efficiency, motor_inertia, period, &Format::FLOAT));
                Ok(GearedConfig { observer, friction: friction as $float, stiction: stiction as $float })
            }
        }
    };
}

float!(f32);
float!(f64);

impl<C: Copy> GearedConfig<Fixed, C> {
    /// An observer's constants behind a gear of this efficiency, driven by this inertia [kg m2] in ticks of this period \[s\].
    ///
    /// # Panics
    /// At compile time in a constant, with the sentence of the [`Error`] that [`try_new`](Self::try_new) returns.
    pub const fn new(observer: C, efficiency: Efficiency, motor_inertia: f64, period: f64, bases: Bases) -> Self {
        or_stop!(Self::try_new(observer, efficiency, motor_inertia, period, bases))
    }

    /// An observer's constants behind a gear of this efficiency, driven by this inertia [kg m2] in ticks of this period \[s\].
    ///
    /// # Errors
    /// [`Error::Value`] for an efficiency that is not above 0 and at most 1, or an inertia or period that is not positive;
    /// [`Error::Coefficient`] for an efficiency below 0.62.
    pub const fn try_new(
        observer: C,
        efficiency: Efficiency,
        motor_inertia: f64,
        period: f64,
        bases: Bases,
    ) -> Result<Self, Error> {
        let [friction, stiction] =
            get!(fixed(get!(losses(efficiency, motor_inertia, period, &Format::fixed(bases))), FIXED));
        Ok(GearedConfig { observer, friction, stiction })
    }
}
