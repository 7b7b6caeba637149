//! The numbers that the tick path calculates with.
//!
//! One algorithm serves three of them: [`f32`] on cores with a floating-point unit, [`f64`] as the host's
//! yardstick, and [`Fixed`] on cores without. Floats are in SI units; [`Fixed`] is per unit of bases that the design
//! chooses from the machine's limits, so that no reachable state overflows.
//!
//! # The carry
//! The tick path is a chain of sums `x + c y`. In fixed point such a sum is a single long multiply-accumulate
//! (`SMLAL`): `x` stands in the upper word of the accumulator, and what remains in the lower word is handed to the
//! next sum instead of being cut off. Cutting off would pull every state downwards by half a unit in the last
//! place each tick; a remainder that is as often large as small takes that pull away, at no cost. For floats
//! the carry is `()`.

mod fixed;
mod float;

pub use fixed::{Coefficient, Fixed};

/// A number that the tick path can calculate with.
pub trait Number: Copy + Default + PartialEq + PartialOrd + core::fmt::Debug {
    /// What a number is multiplied by. In fixed point a fraction of 2^32.
    type Coefficient: Copy + Default + PartialEq + core::fmt::Debug;
    /// How firmly a standing gear is held: a factor for floats; in fixed point always [`STICTION_GAIN`].
    type StictionGain: Copy + Default + PartialEq + core::fmt::Debug;
    /// What one sum leaves to the next.
    type Carry: Copy;
    /// The number as an integer that rises with it among numbers of one sign; that of a float below zero falls.
    type Rank: Copy + Default + Ord + core::fmt::Debug;
    /// A sum of many numbers: a float itself; in fixed point of twice the width.
    type Total: Copy + Default + PartialEq + core::fmt::Debug;

    /// Zero.
    const ZERO: Self;
    /// One: 1 in the SI unit, or the base.
    const ONE: Self;
    /// The carry that a tick begins with.
    const CARRY: Self::Carry;

    /// `self + other`; wraps in fixed point, where the bases leave three bits of headroom.
    fn plus(self, other: Self) -> Self;
    /// `self - other`; wraps in fixed point, where the bases leave three bits of headroom.
    fn minus(self, other: Self) -> Self;
    /// `self + c y`.
    fn accumulate(self, carry: &mut Self::Carry, c: Self::Coefficient, y: Self) -> Self;
    /// `self + (c[0] y[0] + c[1] y[1])`.
    fn accumulate2(self, carry: &mut Self::Carry, c: [Self::Coefficient; 2], y: [Self; 2]) -> Self;
    /// `self + (c[0] y[0] + c[1] y[1] + c[2] y[2])`.
    fn accumulate3(self, carry: &mut Self::Carry, c: [Self::Coefficient; 3], y: [Self; 3]) -> Self;
    /// `c y`.
    fn product(carry: &mut Self::Carry, c: Self::Coefficient, y: Self) -> Self;
    /// `c[0] y[0] + c[1] y[1]`.
    fn sum2(carry: &mut Self::Carry, c: [Self::Coefficient; 2], y: [Self; 2]) -> Self;
    /// `c y`, cut off: for what is not summed over the ticks.
    fn times(self, c: Self::Coefficient) -> Self;
    /// `c[0] y[0] + c[1] y[1]`, cut off.
    fn times2(c: [Self::Coefficient; 2], y: [Self; 2]) -> Self;
    /// The operand of a coefficient that may reach 2 in magnitude: four times the number in fixed point, whose
    /// coefficients end at 1/2, and the number itself in floating point.
    fn widened(self) -> Self;
    /// `self by`, of numbers that are both within a few bases; wraps in fixed point.
    fn scaled(self, by: Self) -> Self;
    /// A part of one, from 2^-32 parts.
    fn fraction(part: u32) -> Self;
    /// Held within twice the base in fixed point; floats are left alone.
    fn saturated(self) -> Self;
    /// In fixed point 1 where any of three saturated states is beyond its base, 0 where not; always 0 for floats.
    fn beyond_base(states: [Self; 3]) -> u32;
    /// `limit` where the number is above it, `-limit` where it is below that.
    fn limited(self, limit: Self) -> Self;
    /// Whether the magnitude is beyond `limit`, which is not negative, or not a number at all.
    fn exceeds(self, limit: Self) -> bool;

    /// `half` with the sign of the number, that of zero being positive: the flank of a backlash that a twist is nearer to.
    fn flank(self, half: Self) -> Self;
    /// Whether the signs differ, of two numbers of which neither is zero.
    fn opposes(self, other: Self) -> bool;
    /// `self^2/travel`, widened, where `travel` is not zero, of the number's sign and at least as large: how far a motion has passed a flank,
    /// times the share of the tick that this took. In fixed point the share has 12 binary places, fewer where the travel is below 2^24 units in the last place.
    fn passed(self, travel: Self) -> Self;

    /// The number without its sign; a negative one in fixed point comes out one unit in the last place short.
    fn magnitude(self) -> Self;

    /// An angle difference, from 2^-32 turns.
    fn from_angle(turned: i32) -> Self;
    /// An angle difference less a turn, which is in 2^-32 turns for floats and 2^-25 turns in fixed point ([`TURN_SHIFT`]).
    fn less_turn(self, turn: Self) -> Self;
    /// An angle difference as the operand of the correction gains.
    fn innovation_operand(self) -> Self;
    /// A difference of speeds or torques as the operand of a governor's gain: held within what a gain may
    /// amplify without overflow.
    fn gain_operand(self) -> Self;

    /// The torque that brings a speed to rest; in fixed point it ends at twice the base.
    fn braked(self, stiction_gain: Self::StictionGain) -> Self;

    /// The speed at which the motor turns by this angle difference in a tick; held within four times the base in fixed point.
    fn speed_of_turn(self, c: Self::Coefficient) -> Self;

    /// The number as an integer to be compared with others of its sign; that of a NaN is beyond infinity.
    fn rank(self) -> Self::Rank;
    /// The number of a rank.
    fn of_rank(rank: Self::Rank) -> Self;

    /// `total` and the number.
    fn added_to(self, total: Self::Total) -> Self::Total;
    /// A total in the SI unit, or per unit of its base: for what is done between the ticks.
    fn total_to_real(total: Self::Total) -> f64;

    /// The value in the SI unit, or per unit of its base: for what is done between the ticks.
    fn to_real(self) -> f64;

    /// The bits, as they travel over a link; an `f64` is rounded to `f32` first.
    fn to_word(self) -> u32;
    /// The number that has these bits.
    fn from_word(word: u32) -> Self;
}

/// Binary places by which a turn in fixed point is coarser than 2^-32 turns: it has a resolution of 2^7 of them (0.19 urad), which the
/// carry refines over the ticks.
pub const TURN_SHIFT: u32 = 7;

/// Binary places by which an innovation is shifted up before its gains, which then range over +-16 units in the last place per 2^-32
/// turn.
pub const INNOVATION_SHIFT: u32 = 5;

/// Torque per speed, per unit, that brings a standing gear to rest in fixed point.
pub const STICTION_GAIN: f64 = 16.0;

/// Largest innovation in 2^-32 turns that fixed point can correct by: 2^26, 5.6 degrees of the motor.
pub const INNOVATION_RANGE: f64 = 67_108_863.0;

/// Binary places by which a governor's gain exceeds other coefficients: gains range over +-16 per unit.
pub const GAIN_SHIFT: u32 = 5;

/// Binary places by which the factor from an angle difference to a speed exceeds other coefficients: it ranges to 32,768 units in the
/// last place per 2^-32 turn.
pub const SPEED_SHIFT: u32 = 16;
