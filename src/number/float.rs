//! Floating point: SI units, no carry, no rails.

use super::Number;

macro_rules! float {
    ($float:ident, $integer:ident) => {
        impl Number for $float {
            type Coefficient = $float;
            type StictionGain = $float;
            type Carry = ();
            type Rank = $integer;
            type Total = $float;

            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const CARRY: () = ();

            #[inline(always)]
            fn plus(self, other: Self) -> Self {
                self + other
            }

            #[inline(always)]
            fn minus(self, other: Self) -> Self {
                self - other
            }

            #[inline(always)]
            fn accumulate(self, _carry: &mut (), c: Self, y: Self) -> Self {
                self + c * y
            }

            #[inline(always)]
            fn accumulate2(self, _carry: &mut (), c: [Self; 2], y: [Self; 2]) -> Self {
                self + (c[0] * y[0] + c[1] * y[1])
            }

            #[inline(always)]
            fn accumulate3(self, _carry: &mut (), c: [Self; 3], y: [Self; 3]) -> Self {
                self + (c[0] * y[0] + c[1] * y[1] + c[2] * y[2])
            }

            #[inline(always)]
            fn product(_carry: &mut (), c: Self, y: Self) -> Self {
                c * y
            }

            #[inline(always)]
            fn sum2(_carry: &mut (), c: [Self; 2], y: [Self; 2]) -> Self {
                c[0] * y[0] + c[1] * y[1]
            }

            #[inline(always)]
            fn times(self, c: Self) -> Self {
                c * self
            }

            #[inline(always)]
            fn times2(c: [Self; 2], y: [Self; 2]) -> Self {
                c[0] * y[0] + c[1] * y[1]
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
            fn beyond_base(_states: [Self; 3]) -> u32 {
                0
            }

            #[inline(always)]
            fn limited(self, limit: Self) -> Self {
                if self > limit {
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
            fn flank(self, half: Self) -> Self {
                if self < 0.0 { -half } else { half }
            }

            #[inline(always)]
            fn opposes(self, other: Self) -> bool {
                self * other < 0.0
            }

            #[inline(always)]
            fn passed(self, travel: Self) -> Self {
                self * (self / travel)
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
            fn less_turn(self, turn: Self) -> Self {
                self - turn
            }

            #[inline(always)]
            fn innovation_operand(self) -> Self {
                self
            }

            #[inline(always)]
            fn gain_operand(self) -> Self {
                self
            }

            #[inline(always)]
            fn braked(self, stiction_gain: Self) -> Self {
                stiction_gain * self
            }

            #[inline(always)]
            fn speed_of_turn(self, c: Self) -> Self {
                c * self
            }

            // The bits without the sign rise with the magnitude.
            #[inline(always)]
            fn rank(self) -> $integer {
                self.to_bits() as $integer
            }

            #[inline(always)]
            fn of_rank(rank: $integer) -> Self {
                $float::from_bits(rank as _)
            }

            #[inline(always)]
            fn added_to(self, total: Self) -> Self {
                total + self
            }

            #[inline(always)]
            fn total_to_real(total: Self) -> f64 {
                total.into()
            }

            #[inline(always)]
            fn to_real(self) -> f64 {
                self.into()
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

float!(f32, i32);
float!(f64, i64);
