//! Fixed point: `i32` values, 2^28 to the base, and `i64` accumulators.

use core::ops::{Add, Neg, Sub};

use super::{GAIN_SHIFT, INNOVATION_SHIFT, Number, SPEED_SHIFT, TURN_SHIFT};

/// A number per unit of its base: 2^28 is the base, the resolution 3.7e-9 of it, the representable range +-8. Sums
/// wrap.
///
/// A state beyond +-1 is reported, and limited to +-2 ([`Number::saturated`]); the bits above are headroom for the sums
/// of a tick.
///
/// ```
/// use driveline::number::Fixed;
/// // 275 N m of a base of 1100 N m: a quarter, in 2^28 to the base
/// let torque = Fixed::from_f64(275.0 / 1100.0);
/// assert_eq!(torque.to_bits(), 1 << 26);
/// assert_eq!((torque + torque).to_f64() * 1100.0, 550.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Fixed(i32);

/// A factor in fixed point: a fraction of 2^32, from -1/2 to just under 1/2.
///
/// ```
/// use driveline::number::{Coefficient, Fixed, Number};
/// // a factor of 0.3 to 2^-32; a half and more has no place
/// let Some(factor) = Coefficient::from_f64(0.3) else { unreachable!() };
/// assert!((Fixed::ONE.times(factor).to_f64() - 0.3).abs() < 1e-8);
/// assert_eq!(Coefficient::from_f64(0.5), None);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Coefficient(i32);

impl Fixed {
    /// The base.
    pub const ONE: Fixed = Fixed(1 << 28);

    /// The number nearest to `value`, in units of the base; saturates at +-8, and a NaN gives zero.
    pub const fn from_f64(value: f64) -> Fixed {
        // A cast from float to integer saturates, and turns NaN into 0.
        Fixed(round(value * 268_435_456.0) as i32)
    }

    /// The value in units of the base.
    pub const fn to_f64(self) -> f64 {
        self.0 as f64 / 268_435_456.0
    }

    /// The number with these bits.
    pub const fn from_bits(bits: i32) -> Fixed {
        Fixed(bits)
    }

    /// The bits: 2^28 to the base.
    pub const fn to_bits(self) -> i32 {
        self.0
    }
}

impl Coefficient {
    /// Zero.
    pub const ZERO: Coefficient = Coefficient(0);

    /// The coefficient nearest to `value`, or `None` where that is not within -1/2 to 1/2.
    pub const fn from_f64(value: f64) -> Option<Coefficient> {
        let scaled = round(value * 4_294_967_296.0);
        if scaled >= -2_147_483_648.0 && scaled <= 2_147_483_647.0 { Some(Coefficient(scaled as i32)) } else { None }
    }

    /// The value.
    pub const fn to_f64(self) -> f64 {
        self.0 as f64 / 4_294_967_296.0
    }

    /// The coefficient with these bits.
    pub const fn from_bits(bits: i32) -> Coefficient {
        Coefficient(bits)
    }

    /// The bits: parts of 2^32.
    pub const fn to_bits(self) -> i32 {
        self.0
    }
}

/// To the nearest integer, halves away from zero; a value too large to have a fraction stays unchanged.
const fn round(value: f64) -> f64 {
    if value.abs() < 4_503_599_627_370_496.0 {
        let half = if value < 0.0 { -0.5 } else { 0.5 };
        ((value + half) as i64) as f64
    } else {
        value
    }
}

#[inline(always)]
fn product(c: Coefficient, y: Fixed) -> i64 {
    c.0 as i64 * y.0 as i64
}

impl Add for Fixed {
    type Output = Fixed;

    #[inline(always)]
    fn add(self, other: Fixed) -> Fixed {
        Fixed(self.0.wrapping_add(other.0))
    }
}

impl Sub for Fixed {
    type Output = Fixed;

    #[inline(always)]
    fn sub(self, other: Fixed) -> Fixed {
        Fixed(self.0.wrapping_sub(other.0))
    }
}

impl Neg for Fixed {
    type Output = Fixed;

    #[inline(always)]
    fn neg(self) -> Fixed {
        Fixed(self.0.wrapping_neg())
    }
}

impl Number for Fixed {
    type Coefficient = Coefficient;
    type Carry = u32;
    type Real = f32;

    const ZERO: Self = Fixed(0);
    const ONE: Self = Fixed::ONE;
    const CARRY: u32 = 1 << 31;

    #[inline(always)]
    fn accumulate<const K: usize>(self, carry: &mut u32, c: [Coefficient; K], y: [Self; K]) -> Self {
        let mut sum = ((self.0 as i64) << 32) | *carry as i64;
        for (&c, y) in c.iter().zip(y) {
            sum = sum.wrapping_add(product(c, y));
        }
        *carry = sum as u32;
        Fixed((sum >> 32) as i32)
    }

    #[inline(always)]
    fn sum<const K: usize>(carry: &mut u32, c: [Coefficient; K], y: [Self; K]) -> Self {
        Fixed(0).accumulate(carry, c, y)
    }

    #[inline(always)]
    fn truncated<const K: usize>(c: [Coefficient; K], y: [Self; K]) -> Self {
        Fixed(0).accumulate(&mut 0, c, y)
    }

    #[inline(always)]
    fn widened(self) -> Self {
        Fixed(self.0 << 2)
    }

    #[inline(always)]
    fn scaled(self, by: Self) -> Self {
        Fixed(((self.0 as i64 * by.0 as i64) >> 28) as i32)
    }

    #[inline(always)]
    fn fraction(part: u32) -> Self {
        Fixed((part >> 4) as i32)
    }

    // Bounds that are powers of two: one SSAT instruction.
    #[inline(always)]
    fn saturated(self) -> Self {
        Fixed(self.0.clamp(-(1 << 29), (1 << 29) - 1))
    }

    #[inline(always)]
    fn addable(self) -> Self {
        Fixed(self.0.clamp(-(1 << 30), (1 << 30) - 1))
    }

    // Bit 28 of a magnitude is set in the union where it is set in any; saturated states have none above it.
    #[inline(always)]
    fn beyond_base<const K: usize>(states: [Self; K]) -> u32 {
        states.into_iter().fold(0, |union, x| union | (x.0 ^ (x.0 >> 31)) as u32) >> 28
    }

    // The limit with the sign of the number, in two instructions.
    #[inline(always)]
    fn limited(self, limit: Self) -> Self {
        let sign = self.0 >> 31;
        if self.exceeds(limit) { Fixed((limit.0 ^ sign).wrapping_sub(sign)) } else { self }
    }

    // -limit..=limit as one range of unsigned numbers.
    #[inline(always)]
    fn exceeds(self, limit: Self) -> bool {
        self.0.wrapping_add(limit.0) as u32 > (limit.0 as u32) << 1
    }

    #[inline(always)]
    fn magnitude(self) -> Self {
        Fixed(self.0 ^ (self.0 >> 31))
    }

    #[inline(always)]
    fn from_angle(turned: i32) -> Self {
        Fixed(turned)
    }

    #[inline(always)]
    fn less_turn(self, turn: Self, rest: u32) -> Self {
        Fixed(self.0.wrapping_sub(turn.0 << TURN_SHIFT).wrapping_sub((rest >> (32 - TURN_SHIFT)) as i32))
    }

    #[inline(always)]
    fn innovation_operand(self) -> Self {
        Fixed(self.0 << INNOVATION_SHIFT)
    }

    // The upper word alone, limited by one SSAT instruction.
    #[inline(always)]
    fn gained<const BASES: i32>(self, gain: Coefficient) -> Self {
        let most = const { BASES << (28 - GAIN_SHIFT) };
        Fixed(((product(gain, self) >> 32) as i32).clamp(-most, most - 1) << GAIN_SHIFT)
    }

    #[inline(always)]
    fn speed_of_turn(self, c: Coefficient) -> Self {
        Fixed((product(c, self) >> (32 - SPEED_SHIFT)).clamp(-(1 << 30), 1 << 30) as i32)
    }

    #[inline(always)]
    fn to_real(self) -> f64 {
        self.to_f64()
    }

    #[inline(always)]
    fn real(self) -> f32 {
        self.0 as f32 * (1.0 / 268_435_456.0)
    }

    #[inline(always)]
    fn to_word(self) -> u32 {
        self.0 as u32
    }

    #[inline(always)]
    fn from_word(word: u32) -> Self {
        Fixed(word as i32)
    }
}

#[cfg(test)]
mod tests {
    use super::{Coefficient, Fixed, Number, round};

    #[test]
    fn halves_round_away_from_zero_and_what_has_no_fraction_stays() {
        // IEC 60559, roundTiesToAway
        for (value, rounded) in [(0.5, 1.0), (-0.5, -1.0), (1.5, 2.0), (2.49, 2.0), (-2.51, -3.0), (0.0, 0.0)] {
            assert_eq!(round(value), rounded);
        }
        let large = 4_503_599_627_370_497.0;
        assert_eq!((round(large), round(-large), round(f64::INFINITY)), (large, -large, f64::INFINITY));
        assert!(round(f64::NAN).is_nan());
    }

    #[test]
    fn a_sum_of_nothing_leaves_number_and_carry() {
        for bits in [i32::MIN, -1, 0, 1, i32::MAX] {
            let mut carry = 0x8765_4321;
            assert_eq!(Fixed::from_bits(bits).accumulate(&mut carry, [], []), Fixed::from_bits(bits));
            assert_eq!(carry, 0x8765_4321);
        }
    }

    #[test]
    fn a_coefficient_ends_at_a_half() {
        let last = 2_147_483_647.0 / 4_294_967_296.0;
        assert_eq!(Coefficient::from_f64(last).map(|c| c.0), Some(i32::MAX));
        assert_eq!(Coefficient::from_f64(-0.5).map(|c| c.0), Some(i32::MIN));
        for beyond in [0.5, -0.500_000_001, f64::NAN, f64::INFINITY] {
            assert_eq!(Coefficient::from_f64(beyond), None);
        }
    }
}
