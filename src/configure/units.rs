//! SI units in and out of a drive, whatever its number.

use super::Machine;
use crate::number::{Fixed, Number};
use crate::sample::{Command, Estimate, Sample};

/// A number type for the quantities of a machine: SI units in floats, per unit of its bases in fixed point.
///
/// ```
#[doc = include_str!("../roll.txt")]
/// use driveline::configure::Units;
/// // generic code of one's own in newton metres: half of rated torque as a command
/// fn half<M: Machine, N: Units>() -> N {
///     N::from_torque::<M>(0.5 * M::RATING.torque.0 as f32)
/// }
/// assert_eq!(half::<Roll, f32>(), 150.0);
/// assert!((half::<Roll, Fixed>().to_torque::<Roll>() - 150.0).abs() < 1e-3);
/// ```
pub trait Units: Number {
    /// A torque (N m).
    fn from_torque<M: Machine>(torque: f32) -> Self;
    /// A speed (rad/s).
    fn from_speed<M: Machine>(speed: f32) -> Self;
    /// This torque (N m).
    fn to_torque<M: Machine>(self) -> f32;
    /// This speed (rad/s).
    fn to_speed<M: Machine>(self) -> f32;
}

macro_rules! float {
    ($float:ident) => {
        impl Units for $float {
            #[inline(always)]
            fn from_torque<M: Machine>(torque: f32) -> Self {
                torque.into()
            }
            #[inline(always)]
            fn from_speed<M: Machine>(speed: f32) -> Self {
                speed.into()
            }
            #[inline(always)]
            fn to_torque<M: Machine>(self) -> f32 {
                self as f32
            }
            #[inline(always)]
            fn to_speed<M: Machine>(self) -> f32 {
                self as f32
            }
        }
    };
}

float!(f32);
float!(f64);

/// Units in the last place to the base.
const ONE: f64 = Fixed::ONE.to_bits() as f64;

/// A value that is not a number is beyond every limit, so the drive rejects it.
fn fixed(units: f32) -> Fixed {
    Fixed::from_bits(if units.is_nan() { i32::MAX } else { units as i32 })
}

impl Units for Fixed {
    fn from_torque<M: Machine>(torque: f32) -> Self {
        fixed(torque * const { (ONE / M::BASES.torque) as f32 })
    }
    fn from_speed<M: Machine>(speed: f32) -> Self {
        fixed(speed * const { (ONE / M::BASES.speed) as f32 })
    }
    fn to_torque<M: Machine>(self) -> f32 {
        self.to_bits() as f32 * const { (M::BASES.torque / ONE) as f32 }
    }
    fn to_speed<M: Machine>(self) -> f32 {
        self.to_bits() as f32 * const { (M::BASES.speed / ONE) as f32 }
    }
}

impl<N: Units> Sample<N> {
    /// A sample in SI units: angle (2^-32 turn), torque (N m), setpoint (rad/s).
    #[inline(always)]
    pub fn si<M: Machine>(angle: u32, torque: f32, setpoint: f32) -> Self {
        Sample { angle, torque: N::from_torque::<M>(torque), setpoint: N::from_speed::<M>(setpoint) }
    }
}

impl<N: Units> Command<N> {
    /// The torque (N m).
    #[inline(always)]
    pub fn torque_si<M: Machine>(&self) -> f32 {
        self.torque.to_torque::<M>()
    }
}

impl<N: Units> Estimate<N> {
    /// The estimate in SI units.
    #[inline(always)]
    pub fn si<M: Machine>(&self) -> Estimate<f32> {
        Estimate {
            motor_speed: self.motor_speed.to_speed::<M>(),
            shaft_torque: self.shaft_torque.to_torque::<M>(),
            load_speed: self.load_speed.to_speed::<M>(),
            load_torque: self.load_torque.to_torque::<M>(),
        }
    }
}
