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
    let mut k = 0;
    while k < 81 {
        let offsets = [k % 3, k / 3 % 3, k / 9 % 3, k / 27];
        let mut tried = rounded;
        let mut i = 0;
        while i < 4 {
            tried[i] += (offsets[i] as f64 - 1.0) * unit[i];
            i += 1;
        }
        let (t, e) = invariants(tried);
        // n11 and n22 have no unit, and are exactly -2 at half the sample rate, where fixed point's range ends.
        let held = tried[0] >= -2.0 && tried[3] >= -2.0;
        // Jury's conditions: |2 + t| <= 2 + e and e <= 0; the second by the rounding of the exact pair.
        if held && e <= excess && e - t >= 0.0 && 4.0 + e + t >= 0.0 && excess - e < gap {
            best = tried;
            gap = excess - e;
        }
        k += 1;
    }
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
