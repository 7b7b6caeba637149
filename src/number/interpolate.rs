//! Linear interpolation of numbers and coefficients, between the ticks.

use super::{Coefficient, Fixed};

/// Position between two points: 0 at the first, 2^16 at the second.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Weight(u32);

impl Weight {
    /// At the first point.
    pub const FIRST: Weight = Weight(0);
    /// At the second point.
    pub const SECOND: Weight = Weight(1 << 16);

    /// The weight between the inverses of two values whose own weight this is, both positive.
    #[must_use]
    pub fn of_inverses<T: Magnitude>(self, from: &T, to: &T) -> Weight {
        let share = self.0 as f32 * (1.0 / 65_536.0);
        let (from, to) = ((1.0 - share) * from.magnitude(), share * to.magnitude());
        Weight::share(to / (from + to))
    }

    /// This share of the way, limited to 0 and 1; NaN is 0.
    pub const fn share(share: f32) -> Weight {
        let weight = (share * 65_536.0) as u32;
        Weight(if weight > 1 << 16 { 1 << 16 } else { weight })
    }
}

/// A factor as a plain number.
pub trait Magnitude: Interpolate {
    /// Its size; in fixed point in units of its own.
    fn magnitude(&self) -> f32;
    /// The factor nearest to a value; at the end of its range beyond it.
    fn of(value: f32) -> Self;
    /// Times a factor near one, from 0 to 2.
    #[must_use]
    fn scaled(&self, factor: f32) -> Self;
}

impl Magnitude for f32 {
    fn magnitude(&self) -> f32 {
        self.abs()
    }
    fn of(value: f32) -> Self {
        value
    }
    fn scaled(&self, factor: f32) -> Self {
        self * factor
    }
}

impl Magnitude for f64 {
    fn magnitude(&self) -> f32 {
        self.abs() as f32
    }
    fn of(value: f32) -> Self {
        value.into()
    }
    fn scaled(&self, factor: f32) -> Self {
        self * f64::from(factor)
    }
}

impl Magnitude for Coefficient {
    fn magnitude(&self) -> f32 {
        (self.to_bits() as f32).abs()
    }
    // The cast saturates.
    fn of(value: f32) -> Self {
        Coefficient::from_bits((value * 4_294_967_296.0) as i32)
    }
    fn scaled(&self, factor: f32) -> Self {
        let change = (factor - 1.0) * self.to_bits() as f32;
        Coefficient::from_bits(self.to_bits().saturating_add(change as i32))
    }
}

/// A value between two others.
pub trait Interpolate: Copy {
    /// From `self` to `other` by a weight; exact at both ends.
    #[must_use]
    fn between(&self, other: &Self, weight: Weight) -> Self;
}

macro_rules! float {
    ($float:ident) => {
        impl Interpolate for $float {
            fn between(&self, other: &Self, weight: Weight) -> Self {
                let share = weight.0 as $float * (1.0 / 65_536.0);
                self * (1.0 - share) + other * share
            }
        }
    };
}

float!(f32);
float!(f64);

/// Of 32 bits with or without a sign: 49 of the product's 64 are needed.
fn bits(from: i64, to: i64, weight: Weight) -> i64 {
    from + (((to - from) * i64::from(weight.0)) >> 16)
}

/// Whole numbers, rounded down.
impl Interpolate for u32 {
    fn between(&self, other: &Self, weight: Weight) -> Self {
        bits((*self).into(), (*other).into(), weight) as u32
    }
}

impl Interpolate for Fixed {
    fn between(&self, other: &Self, weight: Weight) -> Self {
        Fixed::from_bits(bits(self.to_bits().into(), other.to_bits().into(), weight) as i32)
    }
}

impl Interpolate for Coefficient {
    fn between(&self, other: &Self, weight: Weight) -> Self {
        Coefficient::from_bits(bits(self.to_bits().into(), other.to_bits().into(), weight) as i32)
    }
}

/// Constants that there are none of.
impl Interpolate for () {
    fn between(&self, (): &Self, _: Weight) -> Self {}
}

impl<T: Interpolate, const K: usize> Interpolate for [T; K] {
    fn between(&self, other: &Self, weight: Weight) -> Self {
        let mut between = *self;
        for (value, other) in between.iter_mut().zip(other) {
            *value = value.between(other, weight);
        }
        between
    }
}

impl<A: Interpolate, B: Interpolate> Interpolate for (A, B) {
    fn between(&self, other: &Self, weight: Weight) -> Self {
        (self.0.between(&other.0, weight), self.1.between(&other.1, weight))
    }
}

#[cfg(test)]
mod tests {
    use super::{Interpolate, Weight};
    use crate::number::{Coefficient, Fixed};

    #[test]
    fn both_ends_are_exact_and_the_middle_is_half_way() {
        let half = Weight::share(0.5);
        for (a, b) in [(i32::MIN, i32::MAX), (i32::MAX, i32::MIN), (-3, 5), (7, 7)] {
            let (from, to) = (Fixed::from_bits(a), Fixed::from_bits(b));
            assert_eq!(from.between(&to, Weight::FIRST), from);
            assert_eq!(from.between(&to, Weight::SECOND), to);
            // floor of the mean of two integers
            assert_eq!(i64::from(from.between(&to, half).to_bits()), (i64::from(a) + i64::from(b)) >> 1);
        }
        // across 2^31, where a word with a sign would turn over
        assert_eq!(0x7fff_ffff_u32.between(&0x8000_0001, half), 0x8000_0000);
        // k from 1 to 3, half way at 2: its inverse 1/2 is three quarters of the way from 1 to 1/3
        assert_eq!(half.of_inverses(&1.0_f32, &3.0), Weight::share(0.75));
        let (from, to) = (Coefficient::from_f64(-0.5).unwrap(), Coefficient::from_f64(0.25).unwrap());
        assert_eq!(from.between(&to, half).to_f64(), -0.125);
        assert_eq!([1.0_f32, -2.0].between(&[3.0, 2.0], half), [2.0, 0.0]);
    }

    #[test]
    fn a_share_beyond_its_range_is_limited_and_one_that_is_no_number_is_the_first() {
        assert_eq!(Weight::share(-0.1), Weight::FIRST);
        assert_eq!(Weight::share(7.0), Weight::SECOND);
        assert_eq!(Weight::share(f32::INFINITY), Weight::SECOND);
        assert_eq!(Weight::share(f32::NAN), Weight::FIRST);
    }
}
