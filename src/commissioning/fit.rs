//! The two-mass machine that fits responses best.
//!
//! `H = g + b s^2/(s^2 + 2 z w s + w^2) + R s^2` is linear but for w and z: these are looked for on a grid with the
//! linear part solved at each point, and all five then refined together [Golub and Pereyra 1973 (variable projection),
//! Levenberg-Marquardt].

use core::f64::consts::TAU;

use super::complex::Complex;
use super::figure::Figure;
use super::response::Response;
use crate::design::Matrix;
use crate::math::{exp, ln, sqrt};

/// Parameters: g, b, R, ln w, ln z.
const PARAMETERS: usize = 5;

/// The compliance of higher modes moves the response at the highest line by no more than about this, of a rigid
/// machine's: those modes lie above the band.
const COMPLIANCE: f64 = 0.5;

/// A fitted machine, in the unit of a guessed inertia.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Fit {
    /// Unit of inertia (kg m2).
    unit: f64,
    /// Highest frequency (rad/s), the unit of R.
    highest: f64,
    x: [f64; PARAMETERS],
    covariance: [[f64; PARAMETERS]; PARAMETERS],
    /// How much better the data are explained than by a rigid machine, as a ratio of variances: with 3 degrees of
    /// freedom over those of the residual.
    pub improvement: f64,
    /// Variance of the residuals, of that which the noise explains.
    pub excess: f64,
}

/// Quantities derived from a fit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Derived {
    /// Total inertia (kg m2).
    pub total: f64,
    /// Inertia on the motor's side (kg m2).
    pub motor: f64,
    /// Inertia on the load's side (kg m2).
    pub load: f64,
    /// Resonance (rad/s).
    pub resonance: f64,
    /// Antiresonance (rad/s).
    pub antiresonance: f64,
    /// Stiffness (N m/rad).
    pub stiffness: f64,
    /// Damping (N m s/rad).
    pub damping: f64,
    /// Damping ratio of the resonance.
    pub damping_ratio: f64,
}

impl Derived {
    /// How many there are.
    pub const COUNT: usize = 8;

    /// In the order of the fields.
    #[must_use]
    pub fn array(&self) -> [f64; Self::COUNT] {
        [
            self.total,
            self.motor,
            self.load,
            self.resonance,
            self.antiresonance,
            self.stiffness,
            self.damping,
            self.damping_ratio,
        ]
    }
}

/// `s^2/(s^2 + 2 z w s + w^2)` at `s = j frequency`, and its changes with ln w and ln z.
fn mode(frequency: f64, w: f64, z: f64) -> [Complex; 3] {
    let square = -frequency * frequency;
    let damped = Complex::new(0.0, 2.0 * z * w * frequency);
    let below = Complex::new(square + w * w, damped.im);
    let value = Complex::new(square, 0.0).over(below);
    let slope = value.over(below).scaled(-1.0);
    [value, slope.times(damped.plus(Complex::new(2.0 * w * w, 0.0))), slope.times(damped)]
}

/// Sums of weighted least squares with `K` columns.
struct Normal<const K: usize> {
    matrix: Matrix<K, K>,
    right: Matrix<K, 1>,
}

impl<const K: usize> Normal<K> {
    const EMPTY: Self = Self { matrix: Matrix([[0.0; K]; K]), right: Matrix([[0.0]; K]) };

    fn take(&mut self, columns: &[Complex; K], value: Complex, weight: f64) {
        for ((line, right), a) in self.matrix.0.iter_mut().zip(&mut self.right.0).zip(columns) {
            for (entry, b) in line.iter_mut().zip(columns) {
                *entry += weight * (a.re * b.re + a.im * b.im);
            }
            right[0] += weight * (a.re * value.re + a.im * value.im);
        }
    }
}

/// Responses in the units of the fit.
struct Data<'r> {
    responses: &'r [Response],
    unit: f64,
    highest: f64,
}

impl Data<'_> {
    /// Frequency, response, weight, and the column of R.
    fn each(&self) -> impl Iterator<Item = (f64, Complex, f64, f64)> + '_ {
        self.responses.iter().filter(|response| response.frequency > 0.0).map(|response| {
            let spread = (response.standard_deviation * self.unit).max(1.0e-9);
            let share = response.frequency / self.highest;
            (response.frequency, response.complex().scaled(self.unit), 1.0 / (spread * spread), -share * share)
        })
    }

    /// The linear part for a given resonance; its weighted residual.
    fn linear(&self, w: f64, z: f64) -> Option<([f64; 3], f64)> {
        let mut normal = Normal::<3>::EMPTY;
        for (frequency, value, weight, compliance) in self.each() {
            let [m, ..] = mode(frequency, w, z);
            normal.take(&[Complex::new(1.0, 0.0), m, Complex::new(compliance, 0.0)], value, weight);
        }
        normal.matrix.0[2][2] += 1.0 / (COMPLIANCE * COMPLIANCE);
        let solved = normal.matrix.solve(&normal.right)?;
        let [[g], [b], [r]] = solved.0;
        let x = [g, b, r, ln(w), ln(z)];
        Some(([g, b, r], self.residual(&x)))
    }

    fn residual(&self, x: &[f64; PARAMETERS]) -> f64 {
        let [g, b, r, lw, lz] = *x;
        let (w, z) = (exp(lw), exp(lz));
        let mut sum = r * r / (COMPLIANCE * COMPLIANCE);
        for (frequency, value, weight, compliance) in self.each() {
            let [m, ..] = mode(frequency, w, z);
            let model = m.scaled(b).plus(Complex::new(g + r * compliance, 0.0));
            sum += weight * value.minus(model).square();
        }
        sum
    }

    /// Normal equations of all five about a point.
    fn normal(&self, x: &[f64; PARAMETERS]) -> Normal<PARAMETERS> {
        let [g, b, r, lw, lz] = *x;
        let (w, z) = (exp(lw), exp(lz));
        let mut normal = Normal::EMPTY;
        for (frequency, value, weight, compliance) in self.each() {
            let [m, by_w, by_z] = mode(frequency, w, z);
            let model = m.scaled(b).plus(Complex::new(g + r * compliance, 0.0));
            let columns = [Complex::new(1.0, 0.0), m, Complex::new(compliance, 0.0), by_w.scaled(b), by_z.scaled(b)];
            normal.take(&columns, value.minus(model), weight);
        }
        normal.matrix.0[2][2] += 1.0 / (COMPLIANCE * COMPLIANCE);
        normal.right.0[2][0] -= r / (COMPLIANCE * COMPLIANCE);
        normal
    }

    /// A rigid machine's residual.
    fn rigid(&self) -> f64 {
        let mut normal = Normal::<2>::EMPTY;
        for (_, value, weight, compliance) in self.each() {
            normal.take(&[Complex::new(1.0, 0.0), Complex::new(compliance, 0.0)], value, weight);
        }
        normal.matrix.0[1][1] += 1.0 / (COMPLIANCE * COMPLIANCE);
        let Some(solved) = normal.matrix.solve(&normal.right) else { return f64::INFINITY };
        let [[g], [r]] = solved.0;
        self.each()
            .map(|(_, value, weight, compliance)| weight * value.minus(Complex::new(g + r * compliance, 0.0)).square())
            .sum()
    }
}

/// Points of the grid.
const PLACES: u32 = 96;

/// Fits responses, with the resonance looked for between two frequencies (rad/s); `unit` is a guess of the inertia
/// (kg m2). `None` for fewer than six responses, and where no two masses with positive inertias fit.
#[must_use]
pub fn fit(responses: &[Response], unit: f64, between: [f64; 2]) -> Option<Fit> {
    let highest = responses.iter().map(|response| response.frequency).fold(0.0, f64::max);
    let data = Data { responses, unit, highest };
    let lines = data.each().count();
    let [low, high] = between;
    if lines < 6 || !(low > 0.0 && high > low) {
        return None;
    }
    let mut best = (f64::INFINITY, [0.0; PARAMETERS]);
    let step = ln(high / low) / f64::from(PLACES);
    for place in 0..=PLACES {
        let lw = ln(low) + step * f64::from(place);
        for z in [0.003, 0.01, 0.03, 0.1, 0.3] {
            let Some(([g, b, r], residual)) = data.linear(exp(lw), z) else { continue };
            if residual < best.0 && g > 0.0 && b > 0.0 {
                best = (residual, [g, b, r, lw, ln(z)]);
            }
        }
    }
    let (mut residual, mut x) = best;
    if !residual.is_finite() {
        return None;
    }
    let mut damping = 1.0e-3;
    for _ in 0..40 {
        let mut normal = data.normal(&x);
        for (k, line) in normal.matrix.0.iter_mut().enumerate() {
            if let Some(entry) = line.get_mut(k) {
                *entry *= 1.0 + damping;
            }
        }
        let Some(change) = normal.matrix.solve(&normal.right) else { break };
        let mut tried = x;
        for (value, [change]) in tried.iter_mut().zip(change.0) {
            // A logarithm that moves by more than a half has lost its way.
            *value += change.clamp(-0.5, 0.5);
        }
        let after = data.residual(&tried);
        if after < residual {
            let gained = residual - after;
            (x, residual) = (tried, after);
            damping *= 0.2;
            if gained < 1.0e-9 * residual {
                break;
            }
        } else {
            damping *= 6.0;
            if damping > 1.0e9 {
                break;
            }
        }
    }
    // No machine has an inertia below zero, and the refinement is unbounded.
    let [g, b, ..] = x;
    if !(g > 0.0 && b > 0.0) {
        return None;
    }
    let freedom = (2 * lines - PARAMETERS) as f64;
    let excess = residual / freedom;
    let inverse = data.normal(&x).matrix.solve(&Matrix::diagonal(&[1.0; PARAMETERS]))?;
    let covariance = inverse.0.map(|line| line.map(|entry| entry * excess));
    let improvement = (data.rigid() - residual) / 3.0 / excess;
    Some(Fit { unit, highest, x, covariance, improvement, excess })
}

impl Fit {
    /// The response of the fit at a frequency (rad/s).
    pub(crate) fn response(&self, frequency: f64) -> Complex {
        let [g, b, r, lw, lz] = self.x;
        let share = frequency / self.highest.max(f64::MIN_POSITIVE);
        let [m, ..] = mode(frequency, exp(lw), exp(lz));
        m.scaled(b).plus(Complex::new(g - r * share * share, 0.0)).scaled(1.0 / self.unit)
    }

    /// Torque of the shaft per torque of the motor at a frequency: `J_l/J (1 + c s)/(1 + c s + s^2/w^2)`.
    pub(crate) fn shaft(&self, frequency: f64) -> f64 {
        let derived = self.derived();
        let (w, z) = (derived.resonance, derived.damping_ratio);
        let damped = Complex::new(1.0, 2.0 * z * frequency / w);
        let below = damped.minus(Complex::new(frequency * frequency / (w * w), 0.0));
        sqrt(damped.over(below).square()) * derived.load / derived.total
    }

    /// The machine of the fit.
    #[must_use]
    pub fn derived(&self) -> Derived {
        derived(&self.x, self.unit, self.highest)
    }

    /// Values and standard deviations, in the order of [`Derived::array`].
    #[must_use]
    pub fn figures(&self) -> [Figure; Derived::COUNT] {
        let values = self.derived().array();
        let mut slopes = [[0.0; PARAMETERS]; Derived::COUNT];
        for k in 0..PARAMETERS {
            let spread = self.covariance.get(k).and_then(|line| line.get(k)).map_or(0.0, |v| sqrt(v.max(0.0)));
            let step = 0.01 * spread + 1.0e-9;
            let moved = |by: f64| {
                let mut x = self.x;
                if let Some(value) = x.get_mut(k) {
                    *value += by;
                }
                derived(&x, self.unit, self.highest).array()
            };
            let (up, down) = (moved(step), moved(-step));
            for ((slope, up), down) in slopes.iter_mut().zip(up).zip(down) {
                if let Some(slope) = slope.get_mut(k) {
                    *slope = (up - down) / (2.0 * step);
                }
            }
        }
        let mut figures = [Figure::default(); Derived::COUNT];
        for ((figure, value), slope) in figures.iter_mut().zip(values).zip(slopes) {
            let mut variance = 0.0;
            for (line, a) in self.covariance.iter().zip(slope) {
                for (entry, b) in line.iter().zip(slope) {
                    variance += a * entry * b;
                }
            }
            *figure = Figure { value, standard_deviation: sqrt(variance.max(0.0)) };
        }
        figures
    }

    /// Whether the resonance lies between two frequencies (Hz), by 2 %.
    pub(crate) fn within(&self, band: [f64; 2]) -> bool {
        let hertz = self.derived().resonance / TAU;
        hertz > 1.02 * band[0] && hertz < 0.98 * band[1]
    }
}

/// The machine behind the parameters: the antiresonance is the zero of the undamped response, that of higher modes
/// included, and the inertias share the total so that it is met, as
/// [`Match::ResonanceAntiresonance`](crate::machine::Match) has it.
fn derived(x: &[f64; PARAMETERS], unit: f64, highest: f64) -> Derived {
    let [g, b, r, lw, lz] = *x;
    let (w, z) = (exp(lw), exp(lz));
    // g - b u/(w^2 - u) - c u = 0 with u the square of the frequency: c u^2 - (g + b + c w^2) u + g w^2 = 0.
    let c = r / (highest * highest).max(f64::MIN_POSITIVE);
    let half = 0.5 * (g + b + c * w * w);
    let root = sqrt((half * half - c * g * w * w).max(0.0));
    let square = g * w * w / (half + root).max(f64::MIN_POSITIVE);
    let total = unit / g;
    let motor = total * square / (w * w);
    let load = total - motor;
    let stiffness = load * square;
    let reduced = motor * load / total;
    Derived {
        total,
        motor,
        load,
        resonance: w,
        antiresonance: sqrt(square.max(0.0)),
        stiffness,
        damping: 2.0 * z * w * reduced,
        damping_ratio: z,
    }
}
