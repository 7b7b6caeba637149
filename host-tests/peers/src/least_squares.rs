//! Balancing weights by least squares: the library's, and three factorisations of `nalgebra`.
//!
//! Case 1 of Darlow 1982: four readings, three planes, condition 7.8.

use driveline::balancing::{Aim, Complex, Influence, Scalar};
use driveline_firmware::scene::{Input, Output};
use nalgebra::{ComplexField, SMatrix, SVector, convert};

use crate::model::Replayed;

/// Readings.
pub const ROWS: usize = 4;
pub const PLANES: usize = 3;

/// Influence coefficients, amplitude and phase in degrees.
const COEFFICIENTS: [[(f64, f64); PLANES]; ROWS] = [
    [(1.41, 45.0), (2.24, 27.0), (3.61, 34.0)],
    [(3.16, 72.0), (4.47, 27.0), (2.24, 27.0)],
    [(2.83, 45.0), (2.24, 27.0), (5.0, 37.0)],
    [(3.16, 18.0), (3.61, 34.0), (4.47, 27.0)],
];

/// Vibration without weights.
const VIBRATION: [(f64, f64); ROWS] = [(3.16, 72.0), (3.16, 18.0), (4.12, 14.0), (5.39, 68.0)];

/// The weights to 50 digits by the normal equations, rounded here.
const WEIGHTS: [(f64, f64); PLANES] = [
    (1.374_525_765_501_567_2, 356.499_133_008_067_13),
    (1.226_678_102_683_798_3, 215.876_562_974_014_3),
    (0.977_266_709_375_972_6, 167.724_445_138_454_77),
];

fn polar((amplitude, degrees): (f64, f64)) -> Complex<f64> {
    let (sin, cos) = ComplexField::sin_cos(degrees.to_radians());
    Complex { re: amplitude * cos, im: amplitude * sin }
}

fn rounded<T: Scalar>(value: (f64, f64)) -> Complex<T> {
    let value = polar(value);
    Complex { re: convert(value.re), im: convert(value.im) }
}

/// Least squares of the case.
pub trait Solver {
    type Number: Scalar;
    /// The weights; zeros where there are none.
    fn weights(&self) -> [Complex<Self::Number>; PLANES];
}

/// The library's `Influence::correct`: it checks its inputs, finds planes that cannot be told apart, and computes the
/// condition and the residual, too.
#[derive(Clone, Copy, Debug)]
pub struct ByLibrary<T: Scalar> {
    influence: Influence<T, ROWS, PLANES>,
    vibration: [Complex<T>; ROWS],
    aim: Aim<T, ROWS, PLANES>,
}

impl<T: Scalar> ByLibrary<T> {
    /// The case; none where the library refuses it.
    pub fn new() -> Option<Self> {
        let mut influence = Influence::new(ROWS, PLANES).ok()?;
        for plane in 0..PLANES {
            influence.set(plane, &COEFFICIENTS.map(|row| rounded(row[plane]))).ok()?;
        }
        Some(ByLibrary { influence, vibration: VIBRATION.map(rounded), aim: Aim::default() })
    }
}

impl<T: Scalar> Solver for ByLibrary<T> {
    type Number = T;

    #[inline(always)]
    fn weights(&self) -> [Complex<T>; PLANES] {
        match self.influence.correct(&self.vibration, &self.aim) {
            Ok(correction) => correction.weights,
            Err(_) => [Complex { re: T::zero(), im: T::zero() }; PLANES],
        }
    }
}

/// A factorisation of `nalgebra`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Factorisation {
    /// Householder's QR.
    Qr,
    /// Singular values.
    Svd,
    /// Cholesky's, of the normal equations, whose condition is the square.
    Normal,
}

/// By `nalgebra`; `HOW` is a number of [`Factorisation`], so that an image reaches one alone.
#[derive(Clone, Copy, Debug)]
pub struct ByNalgebra<T: Scalar, const HOW: usize> {
    influence: SMatrix<Complex<T>, ROWS, PLANES>,
    vibration: SVector<Complex<T>, ROWS>,
}

impl<T: Scalar, const HOW: usize> ByNalgebra<T, HOW> {
    /// The case.
    #[expect(clippy::new_without_default, reason = "as the others")]
    pub fn new() -> Self {
        ByNalgebra {
            influence: SMatrix::from_fn(|row, plane| rounded(COEFFICIENTS[row][plane])),
            vibration: SVector::from_fn(|row, _| rounded(VIBRATION[row])),
        }
    }
}

impl<T: Scalar, const HOW: usize> Solver for ByNalgebra<T, HOW>
where
    Complex<T>: ComplexField<RealField = T>,
{
    type Number = T;

    #[inline(always)]
    fn weights(&self) -> [Complex<T>; PLANES] {
        let right = -self.vibration;
        let solved = if HOW == Factorisation::Qr as usize {
            let qr = self.influence.qr();
            qr.r().solve_upper_triangular(&qr.q().ad_mul(&right))
        } else if HOW == Factorisation::Svd as usize {
            self.influence.svd(true, true).solve(&right, T::default_epsilon()).ok()
        } else {
            let normal = self.influence.ad_mul(&self.influence);
            normal.cholesky().map(|cholesky| cholesky.solve(&self.influence.ad_mul(&right)))
        };
        solved.unwrap_or_else(SVector::zeros).into()
    }
}

/// A solver that solves once a tick.
#[derive(Clone, Copy, Debug)]
pub struct EachTick<S>(pub S);

impl<S: Solver> Replayed for EachTick<S> {
    fn start(&mut self, _: &Input) {}

    #[inline(always)]
    fn tick(&mut self, _: &Input, output: &mut Output) {
        let weights = self.0.weights();
        // all are used, so that none is left out
        let sum = weights.iter().fold(nalgebra::zero::<S::Number>(), |sum, weight| sum + weight.re + weight.im);
        output.torque = sum.to_words()[0];
    }
}

/// Largest error of the weights over their largest, and the rms of the residual vibration, in doubles.
pub fn judged<S: Solver>(solver: &S) -> [f64; 2] {
    let weights = solver.weights().map(|weight| Complex::<f64> {
        re: nalgebra::try_convert(weight.re).unwrap_or(f64::NAN),
        im: nalgebra::try_convert(weight.im).unwrap_or(f64::NAN),
    });
    let (mut error, mut largest, mut squares) = (0.0_f64, 0.0_f64, 0.0);
    for (weight, exact) in weights.iter().zip(WEIGHTS.map(polar)) {
        error = error.max((weight - exact).modulus());
        largest = largest.max(exact.modulus());
    }
    for (row, vibration) in COEFFICIENTS.iter().zip(VIBRATION) {
        let sum = row.iter().zip(&weights).fold(polar(vibration), |sum, (a, weight)| sum + polar(*a) * weight);
        squares += sum.modulus_squared();
    }
    [error / largest, ComplexField::sqrt(squares / ROWS as f64)]
}
