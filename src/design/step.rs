//! The exact step of two masses over one tick, in closed form.

use crate::machine::TwoMass;
use crate::math::{exp, exp_m1, sin_cos, sqrt};

/// Exact zero-order-hold step in increments:
/// `delta += n11 delta + n12 v + g1 s`, `v += n21 delta + n22 v + g2 s`, right sides at the old tick.
///
/// Twist and twist rate are a closed pair: `delta' = v`, `v' = s - w^2 delta - 2 a v` with `w^2 = k/J_r`,
/// `2 a = d/J_r`, `J_r = J_m J_l/(J_m + J_l)`, and s constant over the tick. Everything follows from the answer to a
/// unit step of s from rest, `g1(t) = delta` and `g2(t) = v = g1'(t)`:
///
/// `n11 = -w^2 g1`, `n12 = g2`, `n21 = -w^2 g2`, `n22 = -(w^2 g1 + 2 a g2)`.
///
/// Both are computed without cancellation at any damping and any `w T`: near the start by Taylor's series of the
/// differential equation, elsewhere by sines, by exponentials of the two real roots, or by series in the distance
/// from critical damping.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ExactStep {
    /// Twist from twist (1), less one.
    pub n11: f64,
    /// Twist from twist rate (s).
    pub n12: f64,
    /// Twist from forcing (s2).
    pub g1: f64,
    /// Twist rate from twist (1/s).
    pub n21: f64,
    /// Twist rate from twist rate (1), less one.
    pub n22: f64,
    /// Twist rate from forcing (s).
    pub g2: f64,
    /// Reduction of the twist rate by the shaft: `T - g2` (s), to full precision.
    pub lag: f64,
}

impl ExactStep {
    /// The step of a machine over a period (s); its stiffness and damping may be zero.
    #[must_use]
    pub const fn new(machine: &TwoMass, period: f64) -> Self {
        let reduced = machine.reduced_inertia();
        Self::from_rates(machine.stiffness / reduced, machine.damping / reduced, period)
    }

    /// The step from `w^2 = k/J_r` (1/s2) and `2 a = d/J_r` (1/s) over a period (s).
    #[must_use]
    pub const fn from_rates(w2: f64, two_a: f64, period: f64) -> Self {
        let (g1, g2, lag) = step_response(0.5 * two_a * period, w2 * period * period);
        let (g1, g2, lag) = (g1 * period * period, g2 * period, lag * period);
        Self { n11: -w2 * g1, n12: g2, g1, n21: -w2 * g2, n22: -(w2 * g1 + two_a * g2), g2, lag }
    }
}

/// `(g1, g2, 1 - g2)` of `y'' + 2 x y' + p y = 1` from rest after the time 1, with y = g1 and y' = g2.
const fn step_response(x: f64, p: f64) -> (f64, f64, f64) {
    if x < 1.0 && p < 1.0 {
        return series(x, p);
    }
    // p - x^2: square of the angle turned, or less the square of the real rate.
    let root = sqrt(p);
    let q = (root - x) * (root + x);
    let (g1, g2) = if q > -0.1 { near_or_under(x, p, q) } else { over(x, p, sqrt(-q)) };
    (g1, g2, 1.0 - g2)
}

/// Taylor's series of the differential equation: `(n+2)(n+1) c[n+2] = -2 x (n+1) c[n+1] - p c[n]`.
const fn series(x: f64, p: f64) -> (f64, f64, f64) {
    let mut value = 0.0;
    let mut missing = 0.0;
    let mut terms = [0.0; 32];
    terms[2] = 0.5;
    each!(n, 3..32, {
        let m = (n - 2) as f64;
        terms[n] = -(2.0 * x * (m + 1.0) * terms[n - 1] + p * terms[n - 2]) / ((m + 2.0) * (m + 1.0));
    });
    // Smallest first.
    let mut n = 31;
    while n >= 3 {
        value += terms[n];
        missing -= n as f64 * terms[n];
        n -= 1;
    }
    (0.5 + value, 1.0 - missing, missing)
}

/// Underdamped, or close to critical damping.
const fn near_or_under(x: f64, p: f64, q: f64) -> (f64, f64) {
    let decay = exp(-x);
    // 1 - cos theta and sin(theta)/theta, theta^2 = q of either sign.
    let (versine, sinc) = if q < 1.0 {
        let mut c = 0.0;
        let mut s = 0.0;
        let mut n = 10;
        while n >= 1 {
            let m = n as f64;
            c = (1.0 - c) * q / ((2.0 * m - 1.0) * (2.0 * m));
            s = (1.0 - s) * q / ((2.0 * m) * (2.0 * m + 1.0));
            n -= 1;
        }
        (c, 1.0 - s)
    } else {
        let theta = sqrt(q);
        let half = sin_cos(0.5 * theta).0;
        (2.0 * half * half, sin_cos(theta).0 / theta)
    };
    let moved = -exp_m1(-x) + decay * (versine - x * sinc);
    (moved / p, decay * sinc)
}

/// Overdamped: real rates `x - b` and `x + b`.
const fn over(x: f64, p: f64, b: f64) -> (f64, f64) {
    let fast = x + b;
    let slow = p / fast;
    let twice = 2.0 * b;
    let g2 = exp(-slow) * -exp_m1(-twice) / twice;
    let g1 = if slow < 1.0 {
        (filled(slow) - filled(fast)) / twice
    } else {
        (1.0 - (fast * exp(-slow) - slow * exp(-fast)) / twice) / p
    };
    (g1, g2)
}

/// `(1 - e^-r)/r`.
const fn filled(r: f64) -> f64 {
    if r == 0.0 { 1.0 } else { -exp_m1(-r) / r }
}
