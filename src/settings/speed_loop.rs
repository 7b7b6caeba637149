//! Constants of the speed loop.

use super::convert::{fixed, get, or_stop, per_unit, positive};
use super::{Bases, Error, Format};
use crate::design::SpeedLoopDesign;
use crate::governor::SpeedLoopConfig;
use crate::number::Fixed;

const GAIN: &str =
    "a gain of the speed loop is beyond the range of fixed point: lower its bandwidth or raise the base of the torque";
const TORQUE: &str = "the torque limit of the speed loop must be positive and finite, and at most twice the base of \
    the torque in fixed point";
const RAMP: &str = "the ramp of the speed loop must be positive and finite, and within a tick at most twice the base \
    of the speed in fixed point";

/// Settings of the speed loop beside its gains.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SpeedLoopSettings {
    /// Largest torque, in either direction [N m].
    pub torque_limit: f64,
    /// Largest acceleration of the setpoint [rad/s2].
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
    }
}

macro_rules! float {
    ($float:ident) => {
        impl SpeedLoopConfig<$float> {
            /// The constants of a design as floats.
            ///
            /// # Panics
            /// At compile time in a constant, with the sentence of the [`Error`] that [`try_new`](Self::try_new)
            /// returns.
            pub const fn new(design: &SpeedLoopDesign, settings: SpeedLoopSettings, bases: Bases) -> Self {
                or_stop!(Self::try_new(design, settings, bases))
            }

            /// The constants of a design as floats.
            ///
            /// # Errors
            /// [`Error::Value`] for a torque limit or a ramp that is not positive and finite.
            pub const fn try_new(
                design: &SpeedLoopDesign,
                settings: SpeedLoopSettings,
                _: Bases,
            ) -> Result<Self, Error> {
                let c = speed_loop(design, &settings, &Format::FLOAT);
                Ok(SpeedLoopConfig {
                    proportional: c.proportional as $float,
                    integral: c.integral as $float,
                    damping: c.damping as $float,
                    anti_windup: c.anti_windup as $float,
                    torque_limit: get!(positive(c.torque_limit, TORQUE)) as $float,
                    ramp: get!(positive(c.ramp, RAMP)) as $float,
                })
            }
        }
    };
}

float!(f32);
float!(f64);

impl SpeedLoopConfig<Fixed> {
    /// The constants of a design in fixed point.
    ///
    /// # Panics
    /// At compile time in a constant, with the sentence of the [`Error`] that [`try_new`](Self::try_new) returns.
    pub const fn new(design: &SpeedLoopDesign, settings: SpeedLoopSettings, bases: Bases) -> Self {
        or_stop!(Self::try_new(design, settings, bases))
    }

    /// The constants of a design in fixed point.
    ///
    /// # Errors
    /// [`Error::Coefficient`] for a gain beyond the range of fixed point, [`Error::Value`] for a limit beyond its base.
    pub const fn try_new(design: &SpeedLoopDesign, settings: SpeedLoopSettings, bases: Bases) -> Result<Self, Error> {
        get!(bases.check());
        let c = speed_loop(design, &settings, &Format::fixed(bases));
        let [proportional, integral, damping, anti_windup] =
            get!(fixed([c.proportional, c.integral, c.damping, c.anti_windup], GAIN));
        // Operands are held within 8 bases and the integral within 2: the sum of all must stay within 8.
        if 8.0 * (c.proportional.abs() + c.integral.abs() + c.damping.abs()) > 5.99 {
            return Err(Error::Coefficient(GAIN));
        }
        Ok(SpeedLoopConfig {
            proportional,
            integral,
            damping,
            anti_windup,
            torque_limit: get!(per_unit(c.torque_limit, TORQUE)),
            ramp: get!(per_unit(c.ramp, RAMP)),
        })
    }
}
