//! Between the numbers of the tick path and the integers of a converter.

use core::marker::PhantomData;

use driveline::number::{Fixed, Number};
use driveline::settings::Bases;

/// A number that can be given as a fraction of a converter's range, and made of a converter's counts.
pub trait Scaled: Number {
    /// A factor of [`FullScale`] or [`PerCount`].
    type Factor: Copy + core::fmt::Debug + PartialEq;

    /// The number over full scale, in 1/32768, held within +-32767; `None` where it is not a number.
    fn fraction(self, factor: Self::Factor) -> Option<i32>;

    /// `counts` of a converter as a number.
    fn of_counts(counts: i32, factor: Self::Factor) -> Self;
}

/// The torque that is full scale of an output.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FullScale<N: Scaled>(N::Factor, PhantomData<N>);

/// Value of one count of a converter.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PerCount<N: Scaled>(N::Factor, PhantomData<N>);

impl<N: Scaled> FullScale<N> {
    #[inline(always)]
    pub(super) fn fraction(self, number: N) -> Option<i32> {
        number.fraction(self.0)
    }
}

impl<N: Scaled> PerCount<N> {
    #[inline(always)]
    pub(super) fn times(self, counts: i32) -> N {
        N::of_counts(counts, self.0)
    }
}

macro_rules! float {
    ($float:ident) => {
        impl Scaled for $float {
            type Factor = $float;

            #[inline(always)]
            fn fraction(self, factor: $float) -> Option<i32> {
                let scaled = self * factor;
                if scaled.is_nan() {
                    return None;
                }
                // a cast saturates
                let rounded = (if scaled < 0.0 { scaled - 0.5 } else { scaled + 0.5 }) as i32;
                Some(rounded.clamp(-32767, 32767))
            }

            #[inline(always)]
            fn of_counts(counts: i32, factor: $float) -> $float {
                counts as $float * factor
            }
        }

        impl FullScale<$float> {
            /// Full scale is `torque` (N m), which must not be zero; a negative one turns the output round.
            ///
            /// # Panics
            /// At compile time in a constant, where it is zero or no number.
            pub const fn new(torque: f64) -> Self {
                assert!(torque.is_finite() && torque != 0.0, "the full scale must be finite and not zero");
                FullScale((32768.0 / torque) as $float, PhantomData)
            }
        }

        impl PerCount<$float> {
            /// A count is worth `value`, in the unit that the number shall have.
            ///
            /// # Panics
            /// At compile time in a constant, where it is zero or no number.
            pub const fn new(value: f64) -> Self {
                assert!(value.is_finite() && value != 0.0, "the worth of a count must be finite and not zero");
                PerCount(value as $float, PhantomData)
            }
        }
    };
}

float!(f32);
float!(f64);

/// Binary places of the fraction of a fixed-point factor.
const PLACES: u32 = 16;

impl Scaled for Fixed {
    type Factor = i64;

    /// `factor` is base over full scale, in 2^-16; a number has 28 places, the fraction 15.
    #[inline(always)]
    fn fraction(self, factor: i64) -> Option<i32> {
        let shift = 28 + PLACES - 15;
        let scaled = ((self.to_bits() as i64).saturating_mul(factor).saturating_add(1 << (shift - 1))) >> shift;
        Some(scaled.clamp(-32767, 32767) as i32)
    }

    /// `factor` is the worth of a count over the base, in 2^-(28 + 16).
    #[inline(always)]
    fn of_counts(counts: i32, factor: i64) -> Fixed {
        let scaled = (counts as i64).saturating_mul(factor) >> PLACES;
        Fixed::from_bits(scaled.clamp(i32::MIN as i64, i32::MAX as i64) as i32)
    }
}

impl FullScale<Fixed> {
    /// Full scale is `torque` (N m), which must not be zero; a negative one turns the output round.
    ///
    /// # Panics
    /// At compile time in a constant, where it is zero, no number, or less than 1/32768 of the base.
    pub const fn new(torque: f64, bases: Bases) -> Self {
        assert!(torque.is_finite() && torque != 0.0, "the full scale must be finite and not zero");
        let factor = bases.torque / torque;
        assert!(factor.abs() < 32768.0, "the full scale must not be less than 1/32768 of the base of torque");
        FullScale((factor * 65536.0) as i64, PhantomData)
    }
}

impl PerCount<Fixed> {
    /// A count is worth `value`, and the number is per unit of `base`, both in one unit.
    ///
    /// # Panics
    /// At compile time in a constant, where either is zero or no number, or a count is worth more than the base.
    pub const fn new(value: f64, base: f64) -> Self {
        let factor = value / base;
        assert!(factor.is_finite() && factor != 0.0, "the worth of a count must be finite and not zero");
        assert!(factor.abs() <= 1.0, "a count must not be worth more than the base");
        PerCount((factor * 17_592_186_044_416.0) as i64, PhantomData)
    }
}

#[cfg(test)]
mod tests {
    use super::{Fixed, Scaled};

    /// The base is full scale, so that 2^13 of the number make one of the output.
    #[test]
    fn an_output_in_fixed_point_is_the_nearest_one() {
        for (quarters, output) in [(1, 0), (3, 1), (4, 1), (5, 1), (-1, 0), (-3, -1), (-5, -1)] {
            assert_eq!(Fixed::from_bits(quarters << 11).fraction(1 << 16), Some(output), "{quarters}/4");
        }
        assert_eq!([1, -1].map(|side| Fixed::from_bits(side << 29).fraction(1 << 16)), [Some(32767), Some(-32767)]);
    }
}
