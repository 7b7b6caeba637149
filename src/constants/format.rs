//! How a number type's coefficients are scaled against SI units.

use super::Bases;
use crate::number::{GAIN_SHIFT, INNOVATION_SHIFT, TURN_SHIFT};

/// Scales from SI units to a number type: units per base, and what its operand methods multiply by.
#[derive(Clone, Copy)]
pub(crate) struct Format {
    pub(crate) bases: Bases,
    /// Units in the last place to the base; 1 for floats.
    pub(crate) unit: f64,
    /// What `widened` multiplies by.
    pub(crate) widened: f64,
    /// What `to_turn` multiplies by.
    pub(crate) turn: f64,
    /// What `innovation_operand` multiplies by.
    pub(crate) innovation: f64,
    /// What `gain_operand` multiplies by.
    pub(crate) gain: f64,
}

impl Format {
    /// SI units, nothing shifted.
    pub(crate) const FLOAT: Format =
        Format { bases: Bases::SI, unit: 1.0, widened: 1.0, turn: 1.0, innovation: 1.0, gain: 1.0 };

    /// Fixed point per unit of these bases.
    pub(crate) const fn fixed(bases: Bases) -> Format {
        Format {
            bases,
            unit: 268_435_456.0,
            widened: 4.0,
            turn: (1u64 << TURN_SHIFT) as f64,
            innovation: (1u64 << INNOVATION_SHIFT) as f64,
            gain: (1u64 << GAIN_SHIFT) as f64,
        }
    }
}

/// 2^-32 turns to the radian.
pub(crate) const ANGLE_PER_RADIAN: f64 = 4_294_967_296.0 / core::f64::consts::TAU;
