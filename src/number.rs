//! Number types of the tick: `f32`, `f64` and fixed point.
//!
//! One algorithm serves three of them: [`f32`] on cores with a floating-point unit, [`f64`] as the host's
//! yardstick, and [`Fixed`] on cores without. Floats are in SI units; [`Fixed`] is per unit of bases that the design
//! chooses from the machine's limits, so that no reachable state overflows.
//!
//! # The carry
//! The tick path is a chain of sums `x + c y`. In fixed point such a sum is a single long multiply-accumulate
//! (`SMLAL`): `x` stands in the upper word of the accumulator, and the remainder in the lower word is carried to the
//! next sum instead of being cut off. Cutting off would pull every state downwards by half a unit in the last place
//! each tick; a remainder that is as often large as small takes that pull away, at no cost. For floats the carry is
//! `()`.

mod fixed;
mod float;
mod interpolate;
mod part;
mod real;

pub use fixed::{Coefficient, Fixed};
pub use interpolate::{Interpolate, Magnitude, Weight};
pub use part::{Part, StateOf};
pub use real::Real;

use core::fmt::Debug;
use core::ops::{Add, Neg, Sub};

/// A number that the tick path can calculate with.
///
/// `+` and `-` wrap in fixed point, where the bases leave three bits of headroom. Operations of a single part are
/// traits beside it: [`Gap`](crate::observer::Gap), [`Stiction`](crate::observer::Stiction),
/// [`Ranked`](crate::fluctuation::Ranked), [`Summed`](crate::fluctuation::Summed).
///
/// ```
/// use driveline::number::{Coefficient, Fixed, Number};
/// // the same in each number: an integrator of a hundredth a tick comes to one in a hundred ticks
/// fn integrated<N: Number>(hundredth: N::Coefficient) -> f64 {
///     let (mut sum, mut carry) = (N::ZERO, N::CARRY);
///     for _ in 0..100 {
///         sum = sum.accumulate(&mut carry, [hundredth], [N::ONE]);
///     }
///     sum.to_real()
/// }
/// assert!((integrated::<f64>(0.01) - 1.0).abs() < 1e-12);
/// // without the carry each tick would lose up to 2^-28: 4e-7 in all
/// assert!((integrated::<Fixed>(Coefficient::from_f64(0.01).unwrap_or_default()) - 1.0).abs() < 2e-8);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no number of a drive",
    note = "the number comes first, `f32`, `f64` or `Fixed`: `Drive<f32, TwoMassObserver, SpeedLoop>`"
)]
pub trait Number:
    Copy + Default + PartialEq + PartialOrd + Debug + Add<Output = Self> + Sub<Output = Self> + Neg<Output = Self>
{
    /// Type of a factor. In fixed point a fraction of 2^32.
    type Coefficient: Copy + Default + PartialEq + Debug;
    /// Remainder carried from one sum to the next.
    type Carry: Copy + Default;
    /// The float of readings between the ticks: `f64` for itself, `f32` for the others.
    type Real: Real;

    /// Zero.
    const ZERO: Self;
    /// One: 1 in the SI unit, or the base.
    const ONE: Self;
    /// The carry that a tick begins with.
    const CARRY: Self::Carry;

    /// `self + (c[0] y[0] + c[1] y[1] + ...)`.
    fn accumulate<const K: usize>(self, carry: &mut Self::Carry, c: [Self::Coefficient; K], y: [Self; K]) -> Self;
    /// `c[0] y[0] + c[1] y[1] + ...`.
    fn sum<const K: usize>(carry: &mut Self::Carry, c: [Self::Coefficient; K], y: [Self; K]) -> Self;
    /// `c[0] y[0] + c[1] y[1] + ...`, truncated: for what is not summed over the ticks.
    fn truncated<const K: usize>(c: [Self::Coefficient; K], y: [Self; K]) -> Self;
    /// `c y`, truncated: for what is not summed over the ticks.
    #[inline(always)]
    fn times(self, c: Self::Coefficient) -> Self {
        Self::truncated([c], [self])
    }
    /// The operand of a coefficient that may reach 2 in magnitude: four times the number in fixed point, whose
    /// coefficients end at 1/2, and the number itself in floating point.
    fn widened(self) -> Self;
    /// `self by`, of numbers that are both within a few bases; wraps in fixed point.
    fn scaled(self, by: Self) -> Self;
    /// A part of one, from 2^-32 parts.
    fn fraction(part: u32) -> Self;
    /// Limited to twice the base in fixed point; floats are unchanged.
    fn saturated(self) -> Self;
    /// Limited to four times the base in fixed point, to which as much can be added; floats are unchanged.
    fn addable(self) -> Self;
    /// In fixed point 1 where any of these saturated states is beyond its base, 0 where not; always 0 for floats.
    fn beyond_base<const K: usize>(states: [Self; K]) -> u32;
    /// Limited to `limit`, which is not negative, in either direction; a NaN gives the limit.
    fn limited(self, limit: Self) -> Self;
    /// Whether the magnitude is beyond `limit`, which is not negative, or not a number at all.
    fn exceeds(self, limit: Self) -> bool;
    /// The number without its sign; a negative one in fixed point comes out one unit in the last place short.
    fn magnitude(self) -> Self;

    /// An angle difference, from 2^-32 turns.
    fn from_angle(turned: i32) -> Self;
    /// An angle difference less a turn, which is in 2^-32 turns for floats and 2^-26 turns in fixed point
    /// ([`TURN_SHIFT`]), and less the turn's remainder.
    fn less_turn(self, turn: Self, rest: Self::Carry) -> Self;
    /// An angle difference as the operand of the correction gains.
    fn innovation_operand(self) -> Self;
    /// A difference of speeds times a governor's gain ([`GAIN_SHIFT`]), for what is not summed over the ticks. In fixed
    /// point limited to so many bases, a power of two, with a resolution of 2^-23 of the base.
    fn gained<const BASES: i32>(self, gain: Self::Coefficient) -> Self;

    /// The speed at which the motor turns by this angle difference in a tick; limited to four times the base in fixed
    /// point.
    fn speed_of_turn(self, c: Self::Coefficient) -> Self;

    /// The value in the SI unit, or per unit of its base: for calculations between the ticks.
    fn to_real(self) -> f64;
    /// The same in the precision of the readings.
    fn real(self) -> Self::Real;

    /// The bits, as they travel over a link; an `f64` is rounded to `f32` first.
    fn to_word(self) -> u32;
    /// The number that has these bits.
    fn from_word(word: u32) -> Self;
}

/// Binary places by which a turn in fixed point is coarser than 2^-32 turns: it has a resolution of 2^6 of them (0.09
/// urad), and its remainder that of an angle. A turn of the base of the speed in a tick has a factor of 2^-32 in 16 to
/// 20 places, which is its error: finer turns leave no room for a speed of two turns in a tick, or for a twist of 25
/// rad.
pub const TURN_SHIFT: u32 = 6;

/// Binary places by which an innovation is shifted up before its gains, which then range over +-16 units in the last
/// place per 2^-32 turn.
pub const INNOVATION_SHIFT: u32 = 5;

/// Torque per speed, per unit, that brings a standing gear to rest in fixed point.
pub const STICTION_GAIN: f64 = 16.0;

/// Largest innovation in 2^-32 turns that fixed point can correct by: 2^26, 5.6 degrees of the motor.
pub const INNOVATION_RANGE: f64 = 67_108_863.0;

/// Binary places by which a governor's gain exceeds other coefficients: gains range over +-16 per unit.
pub const GAIN_SHIFT: u32 = 5;

/// Binary places by which the factor from an angle difference to a speed exceeds other coefficients: it ranges to
/// 32,768 units in the last place per 2^-32 turn.
pub const SPEED_SHIFT: u32 = 16;
