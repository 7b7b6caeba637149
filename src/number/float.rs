//! Floating point: SI units, no carry, no rails.

use super::Number;

macro_rules! float {
    ($float:ident) => {
        impl Number for $float {
            type Coefficient = $float;
            type Carry = ();
            type Real = $float;

            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const CARRY: () = ();

            #[inline(always)]
            fn accumulate<const K: usize>(self, carry: &mut (), c: [Self; K], y: [Self; K]) -> Self {
                self + Self::sum(carry, c, y)
            }

            #[inline(always)]
            fn sum<const K: usize>(_carry: &mut (), c: [Self; K], y: [Self; K]) -> Self {
                Self::truncated(c, y)
            }

            #[inline(always)]
            fn truncated<const K: usize>(c: [Self; K], y: [Self; K]) -> Self {
                core::array::from_fn::<Self, K, _>(|k| c[k] * y[k]).into_iter().sum()
            }

            #[inline(always)]
            fn widened(self) -> Self {
                self
            }

            #[inline(always)]
            fn scaled(self, by: Self) -> Self {
                self * by
            }

            // Of 24 bits at most, which an f32 holds without rounding.
            #[inline(always)]
            fn fraction(part: u32) -> Self {
                (part >> 8) as $float * (1.0 / 16_777_216.0)
            }

            #[inline(always)]
            fn saturated(self) -> Self {
                self
            }

            #[inline(always)]
            fn addable(self) -> Self {
                self
            }

            #[inline(always)]
            fn beyond_base<const K: usize>(_states: [Self; K]) -> u32 {
                0
            }

            // Written so that a NaN, which compares with nothing, gives the limit.
            #[inline(always)]
            fn limited(self, limit: Self) -> Self {
                if !(self <= limit) {
                    limit
                } else if self < -limit {
                    -limit
                } else {
                    self
                }
            }

            // Written so that a NaN, which compares with nothing, exceeds every limit.
            #[inline(always)]
            fn exceeds(self, limit: Self) -> bool {
                !(self.abs() <= limit)
            }

            #[inline(always)]
            fn magnitude(self) -> Self {
                self.abs()
            }

            #[inline(always)]
            fn from_angle(turned: i32) -> Self {
                turned as $float
            }

            #[inline(always)]
            fn less_turn(self, turn: Self, _rest: ()) -> Self {
                self - turn
            }

            #[inline(always)]
            fn innovation_operand(self) -> Self {
                self
            }

            #[inline(always)]
            fn gained<const BASES: i32>(self, gain: Self) -> Self {
                self * gain
            }

            #[inline(always)]
            fn speed_of_turn(self, c: Self) -> Self {
                c * self
            }

            #[inline(always)]
            fn to_real(self) -> f64 {
                self.into()
            }

            #[inline(always)]
            fn real(self) -> $float {
                self
            }

            #[inline(always)]
            fn to_word(self) -> u32 {
                (self as f32).to_bits()
            }

            #[inline(always)]
            fn from_word(word: u32) -> Self {
                f32::from_bits(word) as $float
            }
        }
    };
}

float!(f32);
float!(f64);
