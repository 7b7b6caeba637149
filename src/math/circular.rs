//! Sine, cosine and the angle of a point.

use super::{nearest, sqrt};

/// pi/2 in four pieces of 33 bits each (the last one rounded): products with a count below 2^20 are exact.
const HALF_PI: [f64; 4] = [
    f64::from_bits(0x3FF9_21FB_5440_0000),
    f64::from_bits(0x3DD0_B461_1A60_0000),
    f64::from_bits(0x3BA3_198A_2E00_0000),
    f64::from_bits(0x397B_839A_2520_49C1),
];

/// `a - b` as a rounded difference and its rounding error.
const fn difference(a: f64, b: f64) -> (f64, f64) {
    let d = a - b;
    let back = a - d;
    (d, (a - (d + back)) + (back - b))
}

/// Sine and cosine of an angle (rad), within 1 ulp up to 1e6 rad; NaN where the angle is not finite.
///
/// Beyond 1e6 rad the argument reduction loses digits, as many as the angle has grown by.
#[must_use]
pub const fn sin_cos(angle: f64) -> (f64, f64) {
    if !angle.is_finite() {
        return (f64::NAN, f64::NAN);
    }
    let turns = nearest(angle * (1.0 / HALF_PI[0]));
    let (a, lost_a) = difference(angle, turns * HALF_PI[0]);
    let (b, lost_b) = difference(a, turns * HALF_PI[1]);
    let (c, lost_c) = difference(b, turns * HALF_PI[2]);
    let tail = lost_a + lost_b + lost_c - turns * HALF_PI[3];
    let r = c + tail;
    let low = (c - r) + tail;
    let z = r * r;

    // Taylor's series: the first term left out is below 1e-19 at pi/4. Without a loop, whose steps a constant's
    // evaluation counts.
    let sine = 1.0 / -342.0;
    let sine = (1.0 + z * sine) / -272.0;
    let sine = (1.0 + z * sine) / -210.0;
    let sine = (1.0 + z * sine) / -156.0;
    let sine = (1.0 + z * sine) / -110.0;
    let sine = (1.0 + z * sine) / -72.0;
    let sine = (1.0 + z * sine) / -42.0;
    let sine = (1.0 + z * sine) / -20.0;
    let sine = (1.0 + z * sine) / -6.0;
    let sine = r + (r * (z * sine) + low * (1.0 - 0.5 * z));
    let cosine = 1.0 / -380.0;
    let cosine = (1.0 + z * cosine) / -306.0;
    let cosine = (1.0 + z * cosine) / -240.0;
    let cosine = (1.0 + z * cosine) / -182.0;
    let cosine = (1.0 + z * cosine) / -132.0;
    let cosine = (1.0 + z * cosine) / -90.0;
    let cosine = (1.0 + z * cosine) / -56.0;
    let cosine = (1.0 + z * cosine) / -30.0;
    let cosine = (1.0 + z * cosine) / -12.0;
    // cos r = 1 - z/2 + rest, the rest being -z/2 times the bracket left by the loop.
    let half = 0.5 * z;
    let whole = 1.0 - half;
    let cosine = whole + (((1.0 - whole) - half) + (-half * (z * cosine) - r * low));

    match (turns - 4.0 * nearest(turns * 0.25)) as i32 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        -1 => (-cosine, sine),
        _ => (-sine, -cosine),
    }
}

/// Angle of the point `(x, y)` in (-pi, pi] (rad), within 3 ulp; zero for the origin.
#[must_use]
pub const fn atan2(y: f64, x: f64) -> f64 {
    let (ax, ay) = (x.abs(), y.abs());
    if ax == 0.0 && ay == 0.0 {
        return 0.0;
    }
    let (large, small) = if ax > ay { (ax, ay) } else { (ay, ax) };
    // Halving the angle twice leaves a tangent below 0.2.
    let mut t = small / large;
    t /= 1.0 + sqrt(1.0 + t * t);
    t /= 1.0 + sqrt(1.0 + t * t);
    let z = t * t;
    let mut sum = 0.0;
    let mut n = 12;
    while n >= 1 {
        sum = z * (1.0 / (2 * n + 1) as f64 - sum);
        n -= 1;
    }
    // atan t = t (1 - (t^2/3 - t^4/5 + ...))
    let octant = 4.0 * (t - t * sum);
    let quadrant = if ax > ay { octant } else { HALF_PI[0] + (HALF_PI[1] - octant) };
    let half_plane = if x < 0.0 { 2.0 * HALF_PI[0] + (2.0 * HALF_PI[1] - quadrant) } else { quadrant };
    if y < 0.0 { -half_plane } else { half_plane }
}
