//! Elementary functions of an `f32`, in `f32` alone: those of `libm` calculate in `f64`.
//!
//! | function | largest error seen |
//! |---|---|
//! | [`sqrt`] | 1 ulp; zero below the normal numbers |
//! | [`sin_cos`] up to 1000 rad | 1.2e-7 |
//! | [`ln`] of a normal number | 2 ulp, and 1e-7 |

/// The nearest whole number for `|x|` below 2^22; ties go to the even one.
pub(crate) fn nearest(x: f32) -> f32 {
    const SHIFT: f32 = 12_582_912.0; // 1.5 * 2^23
    (x + SHIFT) - SHIFT
}

/// Square root by Newton's method, from half the exponent; zero for what is not positive.
#[inline(never)]
pub(crate) fn sqrt(x: f32) -> f32 {
    if !(f32::MIN_POSITIVE..f32::INFINITY).contains(&x) {
        return if x > 1.0 { x } else { 0.0 };
    }
    let mut y = f32::from_bits((x.to_bits() >> 1) + 0x1fbd_1df5);
    for _ in 0..3 {
        y = 0.5 * (y + x / y);
    }
    y
}

/// Sine and cosine of an angle (rad), by the polynomials of Cephes within an eighth of a turn.
#[inline(never)]
pub(crate) fn sin_cos(angle: f32) -> (f32, f32) {
    let quarters = nearest(angle * core::f32::consts::FRAC_2_PI);
    // pi/2 in three pieces, of which the first two have few places
    let r = ((angle - quarters * 1.570_312_5) - quarters * 4.837_513e-4) - quarters * 7.549_79e-8;
    let z = r * r;
    let sine = r + r * z * (-1.666_665_5e-1 + z * (8.332_161e-3 - z * 1.951_529_6e-4));
    let cosine = 1.0 - 0.5 * z + z * z * (4.166_664_6e-2 + z * (-1.388_731_6e-3 + z * 2.443_315_7e-5));
    let (sine, cosine) = if quarters as i32 & 1 == 0 { (sine, cosine) } else { (cosine, -sine) };
    if quarters as i32 & 2 == 0 { (sine, cosine) } else { (-sine, -cosine) }
}

/// Natural logarithm of a normal number; minus infinity for zero, NaN below.
#[inline(never)]
pub(crate) fn ln(x: f32) -> f32 {
    if !(f32::MIN_POSITIVE..f32::INFINITY).contains(&x) {
        return if x > 1.0 {
            x
        } else if x < 0.0 || x.is_nan() {
            f32::NAN
        } else {
            f32::NEG_INFINITY
        };
    }
    // around 1, by a factor of the root of two either way
    let exponent = (x.to_bits() as i32).wrapping_sub(0x3f35_04f3) >> 23;
    let s = f32::from_bits((x.to_bits() as i32).wrapping_sub(exponent << 23) as u32);
    let s = (s - 1.0) / (s + 1.0);
    let z = s * s;
    // 2 artanh s
    let sum = z * (1.0 / 3.0 + z * (0.2 + z * (1.0 / 7.0 + z * (1.0 / 9.0))));
    exponent as f32 * core::f32::consts::LN_2 + 2.0 * (s + s * sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_those_of_the_processor() {
        for n in 1..5000 {
            let x = f32::from_bits(n * 400_000);
            // three of Newton's steps from 3 % leave rounding
            let exact = if x < f32::MIN_POSITIVE { 0.0 } else { x.sqrt() };
            assert!((sqrt(x) - exact).abs() <= 2e-7 * exact, "{x}");
        }
        assert_eq!((sqrt(0.0), sqrt(-1.0), sqrt(f32::NAN), sqrt(f32::INFINITY)), (0.0, 0.0, 0.0, f32::INFINITY));
    }

    /// The host's in double precision; rounding of the argument's reduction grows with the turns.
    #[test]
    fn sines_and_logarithms_are_those_of_the_host() {
        for n in -40_000..40_000_i32 {
            let x = n as f32 * 0.003_217;
            let ((sine, cosine), (s, c)) = (sin_cos(x), f64::from(x).sin_cos());
            let off = (f64::from(sine) - s).hypot(f64::from(cosine) - c);
            assert!(off < 1.2e-7 + 1e-9 * f64::from(x).abs(), "{x}: {off}");
        }
        for n in 21..5_347 {
            let x = f32::from_bits(n * 400_000);
            let exact = f64::from(x).ln();
            assert!((f64::from(ln(x)) - exact).abs() <= 1e-7 + 2e-7 * exact.abs(), "{x}");
        }
        assert!(ln(-1.0).is_nan() && ln(f32::NAN).is_nan());
        assert_eq!([ln(0.0), ln(1.0), ln(f32::INFINITY)], [f32::NEG_INFINITY, 0.0, f32::INFINITY]);
    }
}
