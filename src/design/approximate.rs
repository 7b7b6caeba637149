//! Cheaper steps of twist and twist rate, and their errors against the exact one.

use super::ExactStep;
use crate::machine::TwoMass;
use crate::math::{atan2, hypot, ln, sqrt};

/// Ticks over which the state error is followed, at the most.
const LONGEST_HORIZON: u32 = 4096;

/// How far an approximate step is from the exact one.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Fidelity {
    /// Largest error of twist and twist rate over [`horizon`](Self::horizon) ticks of free motion, relative to the
    /// start, in the energy norm (twist times w, twist rate); infinite where the step is unstable.
    pub error_bound: f64,
    /// Ticks that the bound covers: one period of the resonance, at least 1 and at most 4096.
    pub horizon: u32,
    /// Relative error of the natural frequency, signed: of the size of the slow pole where the shaft is overdamped.
    pub frequency_error: f64,
    /// Error of the damping ratio, signed.
    pub damping_error: f64,
    /// Size of the larger pole.
    pub spectral_radius: f64,
    /// Whether no pole lies outside the unit circle (an undamped shaft's lie on it).
    pub stable: bool,
}

/// Semi-implicit Euler: `v += dt s - stiffness_dt delta - damping_dt v`, then `delta += dt v` with the new twist rate.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SemiImplicitStep {
    /// Period (s).
    pub dt: f64,
    /// `T k/J_r` (1/s).
    pub stiffness_dt: f64,
    /// `T d/J_r` (1).
    pub damping_dt: f64,
    /// How far it is from the exact step.
    pub fidelity: Fidelity,
}

impl SemiImplicitStep {
    /// The step of a machine over a period (s).
    #[must_use]
    pub const fn new(machine: &TwoMass, period: f64) -> Self {
        let (w2, two_a) = rates(machine);
        let (stiffness_dt, damping_dt) = (period * w2, period * two_a);
        let n = [-period * stiffness_dt, period * (1.0 - damping_dt), -stiffness_dt, -damping_dt];
        Self { dt: period, stiffness_dt, damping_dt, fidelity: Fidelity::of(n, machine, period) }
    }
}

/// Which step an observer should take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum StepChoice {
    /// [`ExactStep`]: twelve multiply-adds.
    Exact,
    /// [`SemiImplicitStep`]: seven.
    SemiImplicit,
}

impl StepChoice {
    /// Error over a period of the resonance below which the cheap step does: 1 %, less than a stiffness is ever known
    /// to.
    pub const THRESHOLD: f64 = 0.01;

    /// The semi-implicit step where it is stable and its [`Fidelity::error_bound`] is at most `threshold`.
    #[must_use]
    pub const fn choose(step: &SemiImplicitStep, threshold: f64) -> Self {
        if step.fidelity.stable && step.fidelity.error_bound <= threshold { Self::SemiImplicit } else { Self::Exact }
    }
}

/// `k/J_r` (1/s2) and `d/J_r` (1/s).
const fn rates(machine: &TwoMass) -> (f64, f64) {
    let reduced = machine.reduced_inertia();
    (machine.stiffness / reduced, machine.damping / reduced)
}

/// The logarithm of the slow pole and the size of the larger pole, from trace and determinant of the increments.
const fn slow_pole(n: [f64; 4]) -> ((f64, f64), f64) {
    let [n11, n12, n21, n22] = n;
    let trace = n11 + n22;
    let determinant = n11 * n22 - n12 * n21;
    let turning = determinant - 0.25 * trace * trace;
    if turning > 0.0 {
        let (re, im) = (1.0 + 0.5 * trace, sqrt(turning));
        let radius = hypot(re, im);
        ((ln(radius), atan2(im, re)), radius)
    } else {
        // The pole less one that is smaller in size, without cancellation.
        let root = sqrt(-turning);
        let far = if trace < 0.0 { 0.5 * trace - root } else { 0.5 * trace + root };
        let near = if far == 0.0 { 0.0 } else { determinant / far };
        let (slow, fast) = ((1.0 + near).abs(), (1.0 + far).abs());
        ((ln(slow), if near < -1.0 { core::f64::consts::PI } else { 0.0 }), slow.max(fast))
    }
}

impl Fidelity {
    /// The fidelity of the increments `[n11, n12, n21, n22]` over a period.
    const fn of(n: [f64; 4], machine: &TwoMass, period: f64) -> Self {
        let (w2, two_a) = rates(machine);
        let w = sqrt(w2);
        let (log, spectral_radius) = slow_pole(n);
        // An undamped step's determinant is 1 but for rounding.
        let stable = spectral_radius <= 1.0 + 4.0 * f64::EPSILON;

        let a = 0.5 * two_a;
        let slow = if w > a { w } else { w2 / (a + sqrt((a - w) * (a + w))) };
        let ratio = if w > a { a / w } else { 1.0 };
        let size = hypot(log.0, log.1);
        let (frequency_error, damping_error) =
            if slow > 0.0 && size > 0.0 { (size / (slow * period) - 1.0, -log.0 / size - ratio) } else { (0.0, 0.0) };

        let ticks = core::f64::consts::TAU / (w * period);
        let horizon = if ticks < LONGEST_HORIZON as f64 { ticks as u32 + 1 } else { LONGEST_HORIZON };
        let error_bound = if stable { state_error(n, machine, period, horizon) } else { f64::INFINITY };
        Self { error_bound, horizon, frequency_error, damping_error, spectral_radius, stable }
    }
}

/// Largest difference of the powers of the two steps, as a Frobenius norm in energy units.
const fn state_error(n: [f64; 4], machine: &TwoMass, period: f64, horizon: u32) -> f64 {
    let exact = ExactStep::new(machine, period);
    let w = machine.resonance();
    // Twist in units of 1/w, or of T where there is no spring.
    let unit = if w > 0.0 { w } else { 1.0 / period };
    // Powers as single numbers, their products written out: the compiler interprets some thousand ticks.
    let (s11, s12, s21, s22) = (1.0 + n[0], n[1] * unit, n[2] / unit, 1.0 + n[3]);
    let (t11, t12, t21, t22) = (1.0 + exact.n11, exact.n12 * unit, exact.n21 / unit, 1.0 + exact.n22);
    let (mut p11, mut p12, mut p21, mut p22) = (1.0, 0.0, 0.0, 1.0);
    let (mut q11, mut q12, mut q21, mut q22) = (1.0, 0.0, 0.0, 1.0);
    let mut largest = 0.0;
    each!(tick, 0..horizon, {
        let (a, b, c, d) = (p11, p21, q11, q21);
        p11 = a * s11 + p12 * s21;
        p12 = a * s12 + p12 * s22;
        p21 = b * s11 + p22 * s21;
        p22 = b * s12 + p22 * s22;
        q11 = c * t11 + q12 * t21;
        q12 = c * t12 + q12 * t22;
        q21 = d * t11 + q22 * t21;
        q22 = d * t12 + q22 * t22;
        let (a, b, c, d) = (p11 - q11, p12 - q12, p21 - q21, p22 - q22);
        let square = a * a + b * b + c * c + d * d;
        if square > largest {
            largest = square;
        }
    });
    sqrt(largest)
}
