//! Constants of a gear's loss.

use super::constants::constants;
use super::format::ANGLE_PER_RADIAN;
use super::{Bases, Error};
use crate::number::{INNOVATION_RANGE, STICTION_GAIN};
use crate::observer::{GearFriction, GearedConfig, LoadGearConfig};

const EFFICIENCY: &str = "the efficiency of the gear must be above 0 and at most 1";
const MOTOR: &str = "the inertia in front of the gear and the period must be positive and finite";
const LOAD: &str = "the inertia behind the shaft and the period must be positive and finite";
const PLAY: &str =
    "the deadband of a sticking gear must not be negative, and at most 5.6 degrees (0.098 rad) in fixed point";
const LIGHT: &str =
    "the inertia in front of the gear is too light for the bases at this rate: raise the rate or the base of the speed";
const FIXED: &str = "the efficiency of the gear must be above 0.58 in fixed point";
const LOAD_FIXED: &str = "the efficiency of the gear must be above 0.5 in fixed point, driven above 0.67";

/// A gear with losses, as an observer has to know it.
///
/// ```
/// use driveline::settings::Gear;
/// // a worm of 80 %: friction of (1 - eta^2)/(1 + eta^2) of the torque
/// const WORM: Gear = Gear { efficiency: 0.8, inertia: 0.35, deadband: 0.01 };
/// assert!((WORM.friction() - 0.36 / 1.64).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Gear {
    /// Efficiency, above 0 and at most 1.
    pub efficiency: f64,
    /// Inertia in front of the gear, which comes to rest when the gear is held (kg m2).
    pub inertia: f64,
    /// Deadband: turn of the motor while the gear sticks (rad), twice the twist of the shaft before it under the
    /// gear's friction, plus a few counts of the encoder.
    pub deadband: f64,
}

impl Gear {
    /// Friction per torque, (1 - eta^2)/(1 + eta^2).
    #[must_use]
    pub const fn friction(&self) -> f64 {
        let square = self.efficiency * self.efficiency;
        (1.0 - square) / (1.0 + square)
    }

    /// Whether fixed point, whose stiction gain follows from its bases, brings the gear to rest in ticks of this period
    /// (s).
    ///
    /// Twice the stiction gain that stops the motor within two ticks would swing, four times would grow.
    pub(crate) const fn holds(&self, period: f64, bases: Bases) -> bool {
        STICTION_GAIN * (bases.torque / bases.speed) <= self.inertia / period
    }

    /// Friction per torque with the part of the torque that is too much, stiction gain (N m s/rad) that stops the motor
    /// within two ticks, and the deadband (2^-32 turn).
    const fn losses(&self, period: f64) -> Result<([f64; 2], f64, f64), Error> {
        let eta = self.efficiency;
        if !(eta > 0.0 && eta <= 1.0 && ((1.0 / eta) as f32).is_finite()) {
            return Err(Error::Value(EFFICIENCY));
        }
        let stiction_gain = 0.5 * self.inertia / period;
        if !(stiction_gain as f32 > 0.0 && (stiction_gain as f32).is_finite() && period > 0.0) {
            return Err(Error::Value(MOTOR));
        }
        let deadband = self.deadband * ANGLE_PER_RADIAN;
        if !(deadband >= 0.0 && deadband < INNOVATION_RANGE) {
            return Err(Error::Value(PLAY));
        }
        let friction = [self.friction(), 1.0 - 2.0 * eta / (1.0 + eta * eta)];
        Ok((friction, stiction_gain, deadband))
    }
}

/// A gear with losses between the shaft and the load, as an observer has to know it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LoadGear {
    /// Efficiency while the motor drives, above 0 and at most 1.
    pub efficiency: f64,
    /// Efficiency while the load drives, at most 1. At zero or below the gear locks itself, and is never driven.
    pub back_efficiency: f64,
    /// Inertia on the load side of the shaft (kg m2).
    pub inertia: f64,
}

impl LoadGear {
    /// Friction per shaft torque while the motor and while the load drives, and the stiction gain (N m s/rad).
    const fn losses(&self, period: f64) -> Result<[f64; 3], Error> {
        let LoadGear { efficiency, back_efficiency, inertia } = *self;
        if !(efficiency > 0.0 && efficiency <= 1.0 && back_efficiency.is_finite() && back_efficiency <= 1.0) {
            return Err(Error::Value(EFFICIENCY));
        }
        let stiction_gain = 0.5 * inertia / period;
        if !(stiction_gain as f32 > 0.0 && (stiction_gain as f32).is_finite() && period > 0.0) {
            return Err(Error::Value(LOAD));
        }
        let driven = if back_efficiency > 0.0 { 1.0 / back_efficiency - 1.0 } else { 1.0 - efficiency };
        if !(driven as f32).is_finite() {
            return Err(Error::Value(EFFICIENCY));
        }
        Ok([1.0 - efficiency, driven, stiction_gain])
    }
}

constants! {
    /// [`Error::Value`] for a figure of the gear that is out of its range, or in fixed point an inertia too light for
    /// the bases; [`Error::Coefficient`] for an efficiency below 0.58 in fixed point.
    impl[C: Copy] GearedConfig[, C], new, try_new(observer: C, gear: &Gear, period: f64), |format| {
        let (friction, stiction_gain, deadband) = get!(gear.losses(period));
        let [share, excess] = get!(To::coefficients(friction, FIXED));
        if format.unit != 1.0 && !gear.holds(period, format.bases) {
            return Err(Error::Value(LIGHT));
        }
        let (friction, stiction_gain) = (GearFriction { share, excess }, To::stiction(stiction_gain));
        Ok(GearedConfig { observer, friction, stiction_gain, deadband: get!(To::angle(deadband, PLAY)) })
    }

    /// [`Error::Value`] for a figure of the gear that is out of its range; [`Error::Coefficient`] in fixed point for
    /// losses above half of the shaft torque.
    impl[C: Copy] LoadGearConfig[, C], new, try_new(observer: C, gear: &LoadGear, period: f64), |_format| {
        let [driving, driven, stiction_gain] = get!(gear.losses(period));
        let [driving, driven] = get!(To::coefficients([driving, driven], LOAD_FIXED));
        Ok(LoadGearConfig { observer, driving, driven, stiction_gain: To::stiction(stiction_gain) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Fixed;

    const GEAR: Gear = Gear { efficiency: 0.8, inertia: 0.5, deadband: 0.01 };

    /// Sixteen times the torque's base over the speed's, against the inertia over the period.
    #[test]
    fn a_firm_gear_is_brought_to_rest() {
        let bases = Bases { torque: 2.0, speed: 4.0, ..Bases::SI };
        assert!(GEAR.holds(0.0625, bases) && !GEAR.holds(0.063, bases));
    }

    #[test]
    fn losses_are_in_range() {
        let ([share, excess], stiction, deadband) = GEAR.losses(0.01).unwrap();
        // what the motor carries for 1 N m behind the gear, driving and driven; some operations
        let found = 1.0 / (1.0 - excess);
        assert!((found * (1.0 + share) - 1.25).abs() < 1e-15 && (found * (1.0 - share) - 0.8).abs() < 1e-15);
        assert_eq!(stiction, 25.0);
        assert!((deadband / (4_294_967_296.0 * 0.01 / core::f64::consts::TAU) - 1.0).abs() < 1e-15);
        let refused = |gear: Gear, period: f64| gear.losses(period).err();
        for inertia in [0.0, -1.0, f64::INFINITY, 1e39, 1e-60] {
            assert_eq!(refused(Gear { inertia, ..GEAR }, 0.01), Some(Error::Value(MOTOR)), "{inertia}");
        }
        for period in [0.0, -0.01, f64::NAN] {
            assert_eq!(refused(GEAR, period), Some(Error::Value(MOTOR)));
        }
        assert_eq!(refused(Gear { inertia: -0.5, ..GEAR }, -0.01), Some(Error::Value(MOTOR)));
        for efficiency in [0.0, -0.5, 1.1, f64::NAN, 1e-39] {
            assert_eq!(refused(Gear { efficiency, ..GEAR }, 0.01), Some(Error::Value(EFFICIENCY)), "{efficiency}");
        }
        let most = INNOVATION_RANGE / ANGLE_PER_RADIAN;
        for (deadband, is_right) in [(0.0, true), (0.999 * most, true), (-1e-9, false), (1.001 * most, false)] {
            assert_eq!(Gear { deadband, ..GEAR }.losses(0.01).is_ok(), is_right, "{deadband}");
        }
        assert!(Gear { efficiency: 1.0, ..GEAR }.losses(0.01).is_ok());
    }

    /// A gear that the load does not drive loses as while the motor drives.
    #[test]
    fn a_gear_that_locks_is_taken_behind_the_shaft() {
        let gear = |back_efficiency| LoadGear { efficiency: 0.75, back_efficiency, inertia: 2.0 };
        // 1/0.5 - 1; 1 - 0.75
        for (back, driven) in [(0.5, 1.0), (0.0, 0.25), (-0.3, 0.25)] {
            assert_eq!(gear(back).losses(0.01), Ok([0.25, driven, 100.0]), "{back}");
        }
        for back in [1.1, f64::NAN, f64::NEG_INFINITY] {
            assert!(gear(back).losses(0.01).is_err(), "{back}");
        }
    }

    /// In fixed point the gear must be brought to rest: 16 times 2 over 4 is 8, the inertia over 1/16 s.
    #[test]
    fn a_light_gear_is_refused_in_fixed_point() {
        let bases = Bases { torque: 2.0, speed: 4.0, ..Bases::SI };
        let made = |period: f64| GearedConfig::<Fixed, ()>::try_new((), &GEAR, period, bases).map(|made| made.deadband);
        assert_eq!(made(0.063), Err(Error::Value(LIGHT)));
        assert!(made(0.0625).is_ok_and(|deadband| deadband == Fixed::from_bits((0.01 * ANGLE_PER_RADIAN) as i32)));
    }
}
