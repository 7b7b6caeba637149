//! How a number type's coefficients are scaled against SI units.

use super::Bases;
use crate::number::{GAIN_SHIFT, INNOVATION_SHIFT, SPEED_SHIFT, TURN_SHIFT};

/// Scales from SI units to a number type: units per base, and the factors of its operand methods.
#[derive(Clone, Copy)]
pub(crate) struct Format {
    pub(crate) bases: Bases,
    /// Units in the last place to the base; 1 for floats.
    pub(crate) unit: f64,
    pub(crate) widened: f64,
    pub(crate) turn: f64,
    pub(crate) innovation: f64,
    pub(crate) gain: f64,
    pub(crate) speed: f64,
}

impl Format {
    /// SI units, nothing shifted.
    pub(crate) const FLOAT: Format =
        Format { bases: Bases::SI, unit: 1.0, widened: 1.0, turn: 1.0, innovation: 1.0, gain: 1.0, speed: 1.0 };

    pub(crate) const fn fixed(bases: Bases) -> Format {
        Format {
            bases,
            unit: 268_435_456.0,
            widened: 4.0,
            turn: (1u64 << TURN_SHIFT) as f64,
            innovation: (1u64 << INNOVATION_SHIFT) as f64,
            gain: (1u64 << GAIN_SHIFT) as f64,
            speed: (1u64 << SPEED_SHIFT) as f64,
        }
    }

    /// Factor from a turn in a tick (2^-32 turn) to a speed.
    pub(crate) const fn speed_of_turn(&self, period: f64) -> f64 {
        let factor = self.unit / (ANGLE_PER_RADIAN * period * self.bases.speed * self.speed);
        // Beyond fixed point (at its base the motor turns by less than 2^-32 turn in a tick) the initial speed is too
        // low and is corrected.
        if self.unit == 1.0 || factor < 0.499 { factor } else { 0.499 }
    }
}

/// 2^-32 turns to the radian.
pub(crate) const ANGLE_PER_RADIAN: f64 = 4_294_967_296.0 / core::f64::consts::TAU;

#[cfg(test)]
mod tests {
    use super::*;

    /// A radian a second is 2^32/tau 1e-12 of a turn's units in a tick of 1e-12 s: a float has its inverse, fixed point
    /// ends below a half.
    #[test]
    fn the_speed_of_a_turn_ends_in_fixed_point() {
        let inverse = core::f64::consts::TAU * 1e12 / 4_294_967_296.0;
        // some operations
        assert!((Format::FLOAT.speed_of_turn(1e-12) / inverse - 1.0).abs() < 1e-15);
        let fixed = Format::fixed(Bases::SI);
        assert_eq!(fixed.speed_of_turn(1e-12), 0.499);
        // 2^28 units to the base over a shift by sixteen
        assert!((fixed.speed_of_turn(1e-3) / (inverse * 1e-9 * 4096.0) - 1.0).abs() < 1e-15);
    }
}
