//! Off the tick: a full solution of three planes and six readings in `f32`, trial runs included.

use driveline::balancing::{Aim, Complex, Entry, Influence, Objective};

use super::Bench;
use crate::Words;
use crate::board::Board;
use crate::self_test::inputs::Program;

type Readings = [Complex<f32>; 6];

/// A baseline, three trial runs with their weights.
type Runs = (Readings, [(Readings, Complex<f32>); 3]);

/// By least squares, and by min-max with limits.
pub fn solves<B: Board>(bench: &mut Bench<'_, B>) {
    bench.measure_long("balance/least-squares", Words::Single, runs, least_squares);
    bench.measure_long("balance/min-max", Words::Single, runs, min_max);
}

fn runs(inputs: &mut Program) -> Runs {
    let mut number = || f32::from_bits(inputs.next_word());
    let mut readings = || core::array::from_fn(|_| Complex { re: number(), im: number() });
    (readings(), core::array::from_fn(|_| (readings(), Complex { re: 0.5, im: 1.5 })))
}

#[inline(never)]
fn least_squares(_: &mut (), runs: &Runs, weights: &mut [Complex<f32>; 3]) {
    solve(runs, weights, Objective::LeastSquares, None);
}

#[inline(never)]
fn min_max(_: &mut (), runs: &Runs, weights: &mut [Complex<f32>; 3]) {
    solve(runs, weights, Objective::MinMax, Some(1.0));
}

#[inline(always)]
fn solve(runs: &Runs, weights: &mut [Complex<f32>; 3], objective: Objective, limit: Option<f32>) {
    let Ok(mut influence) = Influence::<f32, 6, 3>::new(6, 3) else { return };
    for (plane, (with, trial)) in runs.1.iter().enumerate() {
        if influence.learn(plane, &runs.0, with, *trial).is_err() {
            return;
        }
    }
    let aim = Aim { objective, limits: [limit; 3], ..Aim::default() };
    if let Ok(correction) = influence.correct(&runs.0, &aim) {
        *weights = correction.weights;
    }
}

/// Darlow 1982, case 1: influence coefficients of four readings by three planes, amplitude and phase (degrees).
const DARLOW: [[[f32; 2]; 3]; 4] = [
    [[1.41, 45.0], [2.24, 27.0], [3.61, 34.0]],
    [[3.16, 72.0], [4.47, 27.0], [2.24, 27.0]],
    [[2.83, 45.0], [2.24, 27.0], [5.0, 37.0]],
    [[3.16, 18.0], [3.61, 34.0], [4.47, 27.0]],
];
/// Its vibration.
const DARLOW_VIBRATION: [[f32; 2]; 4] = [[3.16, 72.0], [3.16, 18.0], [4.12, 14.0], [5.39, 68.0]];
/// Its least-squares weights, to 50 digits by another program.
const DARLOW_WEIGHTS: [[f32; 2]; 3] = [[1.374_525_8, 356.499_1], [1.226_678_1, 215.876_56], [0.977_266_7, 167.724_45]];

/// Prints how far the weights of a published case are off on this core, in billionths of the largest.
pub fn accuracy<B: Board>(bench: &mut Bench<'_, B>) {
    bench.print_number("accuracy", "balance/darlow", "billionths", darlow().unwrap_or(u32::MAX));
}

fn darlow() -> Option<u32> {
    let mut entry = Entry::new();
    let mut polar = |[amplitude, degrees]: [f32; 2]| entry.polar(amplitude, degrees);
    let mut influence = Influence::<f32, 4, 3>::new(4, 3).ok()?;
    for plane in 0..3 {
        let mut column = [Complex { re: 0.0, im: 0.0 }; 4];
        for (value, row) in column.iter_mut().zip(&DARLOW) {
            *value = polar(*row.get(plane)?);
        }
        influence.set(plane, &column).ok()?;
    }
    let found = influence.correct(&DARLOW_VIBRATION.map(&mut polar), &Aim::default()).ok()?;
    let mut worst = 0.0;
    for (weight, expected) in found.weights.iter().zip(DARLOW_WEIGHTS) {
        let off = *weight - polar(expected);
        let off = off.re.abs() + off.im.abs();
        worst = if off > worst || off.is_nan() { off } else { worst };
    }
    Some((worst / 1.374_525_8 * 1e9) as u32)
}
