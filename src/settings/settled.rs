//! Rounded coefficients of the twist's free motion that do not let a swing grow.

/// The free pair's four coefficients n11, n12, n21, n22, at most one `unit` each from the nearest ones, `rounded`.
/// Rounding then takes nothing off the pair's damping, and no pole lies outside the unit circle.
///
/// The poles are those of 1 + N. The square of the size of a complex pair is 1 + e with e = trace + determinant of N.
/// Rounding each coefficient to nearest leaves e off by about a unit in the last place, in either direction. In `f32`
/// an undamped swing then grows threefold in 1e8 ticks. Of the 81 neighbours the one is taken whose e is next below the
/// exact one. Real poles are left alone: those of a damped pair are far from the circle.
pub(super) const fn settled(exact: [f64; 4], rounded: [f64; 4], unit: [f64; 4]) -> [f64; 4] {
    let (trace, excess) = invariants(exact);
    // Complex, or a double pole: an undamped pair's next to half the sample rate.
    if 0.25 * trace * trace - (excess - trace) > 0.0 && excess < -1e-6 {
        return rounded;
    }
    let mut best = rounded;
    let mut gap = f64::INFINITY;
    each!(k, 0..81, {
        let offsets = [k % 3, k / 3 % 3, k / 9 % 3, k / 27];
        let mut tried = rounded;
        each!(i, 0..4, {
            tried[i] += (offsets[i] as f64 - 1.0) * unit[i];
        });
        let (t, e) = invariants(tried);
        // n11 and n22 have no unit, and are exactly -2 at half the sample rate, where fixed point's range ends.
        let held = tried[0] >= -2.0 && tried[3] >= -2.0;
        // Jury's conditions: |2 + t| <= 2 + e and e <= 0; the second by the rounding of the exact pair.
        if held && e <= excess && e - t >= 0.0 && 4.0 + e + t >= 0.0 && excess - e < gap {
            best = tried;
            gap = excess - e;
        }
    });
    best
}

/// Trace of N, and trace plus determinant.
const fn invariants([n11, n12, n21, n22]: [f64; 4]) -> (f64, f64) {
    let trace = n11 + n22;
    (trace, trace + (n11 * n22 - n12 * n21))
}

/// Distance to the next `f32` of larger magnitude.
pub(super) const fn unit_single(value: f64) -> f64 {
    let single = (value as f32).abs();
    (f32::from_bits(single.to_bits() + 1) - single) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A turn of the pair: its poles are on the unit circle.
    fn turned(angle: f64) -> [f64; 4] {
        let (sine, cosine) = angle.sin_cos();
        [cosine - 1.0, -sine, sine, cosine - 1.0]
    }

    /// Half the sample rate: no coefficient below -2, and both real poles within the circle. With a share of 1e-3 off
    /// one coefficient and a turn by 1e-2 the determinant is 0.9991; with that off both it would be 0.9981.
    #[test]
    fn a_pair_next_to_half_the_sample_rate_stays_within_the_circle() {
        let exact = [-2.0 + 5e-7, 0.0, 0.0, -2.0];
        let found = settled(exact, [-2.0, 0.0, 0.0, -2.0], [1e-3, 1e-2, 1e-2, 1e-3]);
        let (trace, excess) = invariants(found);
        // some operations on numbers up to four
        assert!((excess + 9e-4).abs() < 1e-14 && (2.0 + trace).abs() <= 2.0 + excess, "{found:?} {trace} {excess}");
    }

    /// Real poles of a damped pair stay as they are, even where they were rounded upwards; next to the circle they do
    /// not.
    #[test]
    fn real_poles_are_left_alone() {
        let damped = [-0.5, 0.0, 0.0, -0.2];
        let rounded = [-0.499, 0.0, 0.0, -0.199];
        assert_eq!(settled(damped, rounded, [1e-3; 4]), rounded);
        let slow = [0.0, 0.0, 0.0, -5e-7];
        let found = settled(slow, [0.0, 0.0, 0.0, -4e-7], [1e-7, 1e-9, 1e-9, 1e-7]);
        assert!((invariants(found).1 + 5e-7).abs() < 1e-20, "{found:?}");
    }

    /// Half and half again is a double pole, which counts as a complex pair: nothing is taken off its damping.
    #[test]
    fn a_double_pole_is_a_pair() {
        let exact = [-0.5, 0.0, 0.0, -0.5];
        let found = settled(exact, [-0.499, 0.0, 0.0, -0.499], [1e-3; 4]);
        assert!(invariants(found).1 <= invariants(exact).1, "{found:?}");
    }

    /// The next smaller pole and one on the circle, of 1 - 5.5e-7 and 1 in units of 1e-7 and 3e-8: with 3e-8 beyond the
    /// circle the other's rounding would be made up for.
    #[test]
    fn no_pole_is_beyond_the_circle() {
        let found = settled([0.0, 0.0, 0.0, -5.5e-7], [0.0, 0.0, 0.0, -5e-7], [3e-8, 1e-9, 1e-9, 1e-7]);
        // the others' units are multiplied
        assert!((invariants(found).1 + 6e-7).abs() < 1e-17, "{found:?}");
    }

    /// Next to half the sample rate, in coarse units.
    #[test]
    fn no_coefficient_is_below_minus_two() {
        for step in 1..30 {
            let exact = turned(core::f64::consts::PI - 0.002 * f64::from(step));
            let rounded = exact.map(|exact| (exact / 3e-3).round() * 3e-3);
            let found = settled(exact, rounded, [3e-3; 4]);
            assert!(found[0] >= -2.0 && found[3] >= -2.0, "{step}: {found:?}");
        }
    }

    #[test]
    fn a_unit_is_the_distance_to_the_next_larger_number() {
        for (value, unit) in [(1.0, 1.0 / 8_388_608.0), (-1.0, 1.0 / 8_388_608.0), (0.75, 1.0 / 16_777_216.0)] {
            assert_eq!(unit_single(value), unit);
        }
    }
}
