//! The numbers of the tick path, to and from SI units.

use driveline::number::{Coefficient, Fixed, Number};

/// Angle by which a state is set from outside (2^-32 turn): half of the largest that fixed point corrects by.
pub const KICK: u32 = 1 << 25;

/// A number that a sweep runs in.
pub trait Swept: Number {
    /// Name in the report.
    const NAME: &'static str;
    /// Largest relative error of a rounding; in fixed point half a unit in the last place of the base.
    const ROUNDING: f64;
    /// Whether a coefficient's error is relative to itself, as in floating point, or absolute.
    const FLOATS: bool;

    /// From SI units; `base` counts in fixed point only.
    fn of(value: f64, base: f64) -> Self;
    /// To SI units.
    fn value(self, base: f64) -> f64;
    /// The correction gain that turns an innovation of `KICK` into `value`.
    fn kick(value: f64, base: f64) -> Self::Coefficient;
    /// A coefficient as stored, times what its operand is widened by.
    fn widened_coefficient(c: Self::Coefficient) -> f64;
    /// A coefficient as stored.
    fn coefficient(c: Self::Coefficient) -> f64;
}

macro_rules! float {
    ($float:ident) => {
        impl Swept for $float {
            const NAME: &'static str = stringify!($float);
            const ROUNDING: f64 = 0.5 * $float::EPSILON as f64;
            const FLOATS: bool = true;

            fn of(value: f64, _base: f64) -> Self {
                value as $float
            }

            fn value(self, _base: f64) -> f64 {
                self.into()
            }

            fn kick(value: f64, _base: f64) -> Self {
                (value / f64::from(KICK)) as $float
            }

            fn widened_coefficient(c: Self) -> f64 {
                c.into()
            }

            fn coefficient(c: Self) -> f64 {
                c.into()
            }
        }
    };
}

float!(f32);
float!(f64);

impl Swept for Fixed {
    const NAME: &'static str = "fixed";
    // 2^-28 of the base, halved.
    const ROUNDING: f64 = 1.0 / 536_870_912.0;
    const FLOATS: bool = false;

    fn of(value: f64, base: f64) -> Self {
        Fixed::from_f64(value / base)
    }

    fn value(self, base: f64) -> f64 {
        self.to_f64() * base
    }

    // 2^28 to the base, from an operand of 2^25 shifted up by five.
    fn kick(value: f64, base: f64) -> Coefficient {
        Coefficient::from_f64(0.25 * value / base).expect("a state within twice its base")
    }

    fn widened_coefficient(c: Coefficient) -> f64 {
        4.0 * c.to_f64()
    }

    fn coefficient(c: Coefficient) -> f64 {
        c.to_f64()
    }
}
