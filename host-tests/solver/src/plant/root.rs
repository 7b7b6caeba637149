//! The first root of a polynomial on the unit interval, isolated by bounds and closed in on by bisection and secant.

/// Value of a polynomial, lowest coefficient first.
pub(super) fn value(poly: &[f64], s: f64) -> f64 {
    poly.iter().rev().fold(0.0, |sum, c| sum * s + c)
}

/// Coefficients of the derivative.
pub(super) fn derivative(poly: &[f64]) -> Vec<f64> {
    poly.iter().enumerate().skip(1).map(|(k, c)| k as f64 * c).collect()
}

/// First `s` in `[0, 1]` where a quantity that must not be negative falls below zero.
///
/// A start at zero within `rounding` is judged by the first derivative that stands out of its own rounding: rising, it
/// is on the right side and is left alone until it comes back; falling, the answer is 0. A double root (a grazing
/// touch) is found whenever the polynomial goes below zero in between. The answer lies on the far side of the root,
/// within `tolerance`.
pub(super) fn first_fall(poly: &[f64], rounding: &[f64], tolerance: f64) -> Option<f64> {
    let mut poly = poly.to_vec();
    let mut from = 0.0;
    if poly[0] < -rounding[0] {
        return Some(0.0);
    }
    if poly[0] <= rounding[0] {
        let leading = (1..poly.len()).find(|&k| poly[k].abs() > rounding[k])?;
        if poly[leading] < 0.0 {
            return Some(0.0);
        }
        poly[..leading].fill(0.0);
        let rest: f64 = poly[leading + 1..].iter().map(|c| c.abs()).sum();
        // the leading term outweighs all later ones up to here
        from = if rest > 0.0 { (0.5 * poly[leading] / rest).min(1.0) } else { 1.0 };
    }
    let slope = derivative(&poly);
    let bend = derivative(&slope);
    Search { poly: &poly, slope: &slope, bend: &bend, tolerance }.first(from, 1.0)
}

/// All places in `[0, 1]` where the polynomial changes its sign, in order.
pub(super) fn sign_changes(poly: &[f64], tolerance: f64) -> Vec<f64> {
    let mut found = Vec::new();
    let mut from = 0.0;
    while from < 1.0 && found.len() < poly.len() {
        let ahead = value(poly, from);
        let sign = if ahead == 0.0 { value(poly, 0.5 * (from + 1.0)) } else { ahead }.signum();
        let turned: Vec<f64> = poly.iter().map(|c| c * sign).collect();
        let slope = derivative(&turned);
        let bend = derivative(&slope);
        let search = Search { poly: &turned, slope: &slope, bend: &bend, tolerance };
        let Some(root) = search.first(from, 1.0) else {
            break;
        };
        found.push(root);
        from = if root > from { root } else { from + tolerance.max(1e-9) };
    }
    found
}

struct Search<'a> {
    poly: &'a [f64],
    slope: &'a [f64],
    bend: &'a [f64],
    tolerance: f64,
}

impl Search<'_> {
    /// Halves the interval until bounds on the second derivative settle whether it holds a root.
    fn first(&self, a: f64, b: f64) -> Option<f64> {
        let h = b - a;
        let (at_a, at_b) = (value(self.poly, a), value(self.poly, b));
        let bound = value(&self.bend.iter().map(|c| c.abs()).collect::<Vec<_>>(), b);
        // of a run that overflowed: halving would go on for ever
        if !(at_a + at_b + bound).is_finite() {
            return None;
        }
        let (slope_a, slope_b) = (value(self.slope, a), value(self.slope, b));
        let falling = slope_a + bound * h <= 0.0 || slope_b + bound * h <= 0.0;
        if at_a >= 0.0 && at_b >= 0.0 {
            let clear = at_a.min(at_b) >= 0.125 * bound * h * h;
            let rising = slope_a - bound * h >= 0.0 || slope_b - bound * h >= 0.0;
            if clear || rising || falling {
                return None;
            }
        }
        if at_a < 0.0 {
            return Some(a);
        }
        if h <= self.tolerance {
            return (at_b < 0.0).then_some(b);
        }
        if at_b < 0.0 && falling {
            return Some(self.close_in(a, b, at_a, at_b));
        }
        let middle = 0.5 * (a + b);
        self.first(a, middle).or_else(|| self.first(middle, b))
    }

    /// Illinois' false position with bisection as a guard; gives the far end of the last bracket.
    fn close_in(&self, mut a: f64, mut b: f64, mut at_a: f64, mut at_b: f64) -> f64 {
        for round in 0..200 {
            if b - a <= self.tolerance {
                break;
            }
            let guess = if round % 3 == 2 { 0.5 * (a + b) } else { b - at_b * (b - a) / (at_b - at_a) };
            // a step of half the tolerance past the guess makes the bracket shut from both sides
            let side = if round % 2 == 0 { 0.5 } else { -0.5 };
            let s = (guess + side * self.tolerance).clamp(a, b);
            let s = if s > a && s < b { s } else { 0.5 * (a + b) };
            if s <= a || s >= b {
                break;
            }
            let at_s = value(self.poly, s);
            if at_s < 0.0 {
                (b, at_b) = (s, at_s);
            } else {
                (a, at_a) = (s, at_s);
            }
        }
        b
    }
}

#[cfg(test)]
mod tests {
    use crate::plant::root::*;

    const NONE: [f64; 5] = [0.0; 5];

    #[test]
    fn a_dip_a_millionth_deep_is_found() {
        // (s - 1/3)^2 - 1e-12: below zero for 2e-6 of the interval
        let poly = [1.0 / 9.0 - 1e-12, -2.0 / 3.0, 1.0];
        let root = first_fall(&poly, &NONE, 1e-15).unwrap();
        // the slope there is 2e-6, so rounding of 1e-16 moves the root by 1e-10
        assert!((root - (1.0 / 3.0 - 1e-6)).abs() < 1e-9, "{root}");
        let above = [1.0 / 9.0 + 1e-12, -2.0 / 3.0, 1.0];
        assert_eq!(first_fall(&above, &NONE, 1e-15), None);
    }

    #[test]
    fn a_start_at_zero_is_judged_by_where_it_goes() {
        assert_eq!(first_fall(&[0.0, -1.0], &NONE, 1e-15), Some(0.0));
        assert_eq!(first_fall(&[0.0, 0.0, 1.0], &NONE, 1e-15), None);
        // of numbers that overflowed nothing is found, and soon
        assert_eq!(first_fall(&[f64::NAN, -1.0, 1.0], &[f64::NAN; 3], 1e-15), None);
        assert_eq!(first_fall(&[1.0, -1e308, f64::INFINITY], &NONE, 1e-15), None);
        // s (1/2 - s): rises, comes back at one half
        let back = first_fall(&[0.0, 0.5, -1.0], &NONE, 1e-15).unwrap();
        // simple root, slope 1/2: rounding and tolerance only
        assert!((back - 0.5).abs() < 1e-14, "{back}");
    }

    #[test]
    fn all_sign_changes_in_order() {
        // (s - 0.2)(s - 0.5)(s - 0.9)
        let found = sign_changes(&[-0.09, 0.73, -1.6, 1.0], 1e-15);
        assert_eq!(found.len(), 3, "{found:?}");
        for (root, exact) in found.iter().zip([0.2, 0.5, 0.9]) {
            // simple roots with slopes above 0.1
            assert!((root - exact).abs() < 1e-14, "{found:?}");
        }
    }
}
