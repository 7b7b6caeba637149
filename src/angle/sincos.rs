//! Sine and cosine on the tick, from a table with the slope at each place.

use crate::math::sin_cos;
use crate::number::{Fixed, Number};

const PLACES: usize = 128;
const QUARTER: usize = PLACES / 4;
/// Binary places of an angle.
const ANGLE: u32 = 26;
/// Those below the place.
const BELOW: u32 = ANGLE - PLACES.trailing_zeros();
const ONE: i32 = 1 << 24;

/// The sine at each place, for a tangent half a place either way whose ends are as far out as its middle is in.
const fn table() -> [f64; PLACES + QUARTER] {
    let half = core::f64::consts::PI / PLACES as f64;
    // the mean of 1 + x^2/2 over the place
    let radius = 1.0 / (1.0 + half * half / 6.0);
    let mut table = [0.0; PLACES + QUARTER];
    each!(place, 0..PLACES + QUARTER, {
        let (sine, _) = sin_cos((2 * place) as f64 * half);
        table[place] = radius * sine;
    });
    table
}

static SINGLE: [f32; PLACES + QUARTER] = {
    let (exact, mut rounded) = (table(), [0.0; PLACES + QUARTER]);
    each!(place, 0..PLACES + QUARTER, {
        rounded[place] = exact[place] as f32;
    });
    rounded
};

static FIXED: [i32; PLACES + QUARTER] = {
    let (exact, mut rounded) = (table(), [0; PLACES + QUARTER]);
    each!(place, 0..PLACES + QUARTER, {
        let half = if exact[place] < 0.0 { -0.5 } else { 0.5 };
        rounded[place] = (exact[place] * ONE as f64 + half) as i32;
    });
    rounded
};

/// The distance from the nearest place, 2^31 to half a place.
#[inline(always)]
fn beside(angle: u32) -> i32 {
    (angle << (32 - BELOW)) as i32
}

#[inline(always)]
fn place(angle: u32) -> usize {
    (angle.wrapping_add(1 << (BELOW - 1)) >> BELOW) as usize & (PLACES - 1)
}

/// A number that a phasor can be measured in.
///
/// 128 places on a turn and the tangent there: the error is 1.5e-4 at most and zero on average, since the radius is
/// that of the mean. That is a thirtieth of a reading's tolerance, for 640 bytes of flash and the two multiplications
/// of the slope. The table holds the sine of a turn and a quarter: a cosine is the sine a quarter on.
pub trait Synchronous: Number {
    /// A cosine or a sine, or a difference of two.
    type Part: Copy + Default + PartialEq + core::fmt::Debug;
    /// A sum of numbers times parts.
    type Sum: Copy + Default + PartialEq + core::fmt::Debug;
    /// Cosine and sine of nothing.
    const AHEAD: [Self::Part; 2];

    /// Cosine and sine of an angle (2^-26 turn).
    fn direction(angle: u32) -> [Self::Part; 2];
    /// The difference of two parts.
    fn change(to: Self::Part, from: Self::Part) -> Self::Part;
    /// A sum and this number times a part.
    fn added(self, sum: Self::Sum, part: Self::Part) -> Self::Sum;
    /// The growth of a sum, in units of the number.
    fn growth(to: Self::Sum, from: Self::Sum) -> f32;
}

impl Synchronous for f32 {
    type Part = f32;
    type Sum = f32;
    const AHEAD: [f32; 2] = [1.0, 0.0];

    #[inline(always)]
    fn direction(angle: u32) -> [f32; 2] {
        let place = place(angle);
        let [cosine, sine] = [SINGLE[place + QUARTER], SINGLE[place]];
        let slope = beside(angle) as f32 * const { (core::f64::consts::PI / PLACES as f64 / 2_147_483_648.0) as f32 };
        [cosine - sine * slope, sine + cosine * slope]
    }

    #[inline(always)]
    fn change(to: f32, from: f32) -> f32 {
        to - from
    }

    #[inline(always)]
    fn added(self, sum: f32, part: f32) -> f32 {
        sum + self * part
    }

    fn growth(to: f32, from: f32) -> f32 {
        to - from
    }
}

/// The yardstick: sine and cosine to the last place, slowly.
impl Synchronous for f64 {
    type Part = f64;
    type Sum = f64;
    const AHEAD: [f64; 2] = [1.0, 0.0];

    #[inline(always)]
    fn direction(angle: u32) -> [f64; 2] {
        let (sine, cosine) = sin_cos(f64::from(angle) * (core::f64::consts::TAU / 67_108_864.0));
        [cosine, sine]
    }

    #[inline(always)]
    fn change(to: f64, from: f64) -> f64 {
        to - from
    }

    #[inline(always)]
    fn added(self, sum: f64, part: f64) -> f64 {
        sum + self * part
    }

    fn growth(to: f64, from: f64) -> f32 {
        (to - from) as f32
    }
}

/// Parts of 2^24, sums of 2^52 to the base: a block of 300 turns at twice the base fits, and whole readings may wrap.
impl Synchronous for Fixed {
    type Part = i32;
    type Sum = i64;
    const AHEAD: [i32; 2] = [ONE, 0];

    #[inline(always)]
    fn direction(angle: u32) -> [i32; 2] {
        let place = place(angle);
        let [cosine, sine] = [FIXED[place + QUARTER], FIXED[place]];
        // 2^36 to the radian, of which a unit of the angle has 2 pi 2^10 = 6433.98
        let slope = (beside(angle) >> (32 - BELOW)).wrapping_mul(6434);
        let along = |part: i32| ((i64::from(part) * i64::from(slope)) >> 32) as i32 >> 4;
        [cosine - along(sine), sine + along(cosine)]
    }

    #[inline(always)]
    fn change(to: i32, from: i32) -> i32 {
        to.wrapping_sub(from)
    }

    #[inline(always)]
    fn added(self, sum: i64, part: i32) -> i64 {
        sum.wrapping_add(i64::from(self.to_bits()) * i64::from(part))
    }

    fn growth(to: i64, from: i64) -> f32 {
        to.wrapping_sub(from) as f32 * (1.0 / 4_503_599_627_370_496.0)
    }
}

#[cfg(test)]
mod tests {
    use super::Synchronous;
    use crate::number::Fixed;

    /// Half a place is x = pi/128; the tangent is out by x^2/2 at its ends over the radius of the mean, x^2/6: x^2/3 =
    /// 2.0e-4, and in by x^2/6 = 1.0e-4 in the middle. Fixed point adds three units in the last place at most:
    /// half in the table, one where the product is cut off, and 3e-6 of the slope's 2^24 pi/128, which is 1.3.
    #[test]
    fn directions_are_those_of_the_angle() {
        let every = if cfg!(miri) { 100 } else { 1 };
        for n in (0..100_003_u32).step_by(every) {
            let angle = n.wrapping_mul(671) & 0x03ff_ffff;
            let exact = <f64 as Synchronous>::direction(angle);
            let single = <f32 as Synchronous>::direction(angle);
            let fixed = <Fixed as Synchronous>::direction(angle);
            for k in 0..2 {
                assert!((f64::from(single[k]) - exact[k]).abs() < 2.1e-4, "{angle}");
                assert!((f64::from(fixed[k]) / 16_777_216.0 - exact[k]).abs() < 2.1e-4, "{angle}");
            }
        }
    }
}
