//! Constants of backlash take-up.

use super::convert::{fixed, get, or_stop, per_unit, positive};
use super::{Bases, Error, Format};
use crate::design::BacklashTakeUpDesign;
use crate::governor::BacklashTakeUpConfig;
use crate::number::Fixed;

const GAIN: &str = "a gain of the backlash take-up is beyond the range of fixed point: let its impact be larger, \
    damp less, or raise the base of the torque";
const TORQUE: &str = "torque, rise and largest torque of the backlash take-up must be positive and finite, and at most \
    twice \
    the base of the torque in fixed point";

/// Torque, step, most, braking and damping, scaled to a format.
const fn take_up(design: &BacklashTakeUpDesign, format: &Format) -> [f64; 5] {
    let Bases { torque, speed, .. } = format.bases;
    let scale = speed / (torque * format.gain);
    [
        design.torque / torque,
        design.slew * design.period / torque,
        design.max_torque / torque,
        -design.braking * scale,
        -design.damping * scale,
    ]
}

macro_rules! float {
    ($float:ident) => {
        impl<L: Copy> BacklashTakeUpConfig<$float, L> {
            /// The constants of a design as floats, round another limit.
            ///
            /// # Panics
            /// At compile time in a constant, with the sentence of the [`Error`] that [`try_new`](Self::try_new)
            /// returns.
            pub const fn new(design: &BacklashTakeUpDesign, limit: L, bases: Bases) -> Self {
                or_stop!(Self::try_new(design, limit, bases))
            }

            /// The constants of a design as floats, round another limit.
            ///
            /// # Errors
            /// [`Error::Value`] for a figure that is not positive and finite.
            pub const fn try_new(design: &BacklashTakeUpDesign, limit: L, _: Bases) -> Result<Self, Error> {
                let [torque, step, max_torque, braking, damping] = take_up(design, &Format::FLOAT);
                Ok(BacklashTakeUpConfig {
                    torque: get!(positive(torque, TORQUE)) as $float,
                    braking: braking as $float,
                    step: get!(positive(step, TORQUE)) as $float,
                    max_torque: get!(positive(max_torque, TORQUE)) as $float,
                    damping: damping as $float,
                    limit,
                })
            }
        }
    };
}

float!(f32);
float!(f64);

impl<L: Copy> BacklashTakeUpConfig<Fixed, L> {
    /// The constants of a design in fixed point, round another limit.
    ///
    /// # Panics
    /// At compile time in a constant, with the sentence of the [`Error`] that [`try_new`](Self::try_new) returns.
    pub const fn new(design: &BacklashTakeUpDesign, limit: L, bases: Bases) -> Self {
        or_stop!(Self::try_new(design, limit, bases))
    }

    /// The constants of a design in fixed point, round another limit.
    ///
    /// # Errors
    /// [`Error::Coefficient`] for a gain beyond the range of fixed point, [`Error::Value`] for a figure beyond its
    /// base.
    pub const fn try_new(design: &BacklashTakeUpDesign, limit: L, bases: Bases) -> Result<Self, Error> {
        get!(bases.check());
        let [torque, step, max_torque, braking, damping] = take_up(design, &Format::fixed(bases));
        // Operands are held within 8 bases: with a torque of twice its base beside them the sum must stay within 8.
        if 8.0 * -braking > 5.99 || 8.0 * -damping > 5.99 {
            return Err(Error::Coefficient(GAIN));
        }
        let [braking, damping] = get!(fixed([braking, damping], GAIN));
        Ok(BacklashTakeUpConfig {
            torque: get!(per_unit(torque, TORQUE)),
            braking,
            step: get!(per_unit(step, TORQUE)),
            max_torque: get!(per_unit(max_torque, TORQUE)),
            damping,
            limit,
        })
    }
}
