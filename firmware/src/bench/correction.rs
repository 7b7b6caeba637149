//! What is off the tick: a full solve of three planes and six readings in `f32`, trial runs included.

use driveline::balance::{Aim, Complex, Influence, Objective};

use super::Bench;
use crate::Words;
use crate::board::Board;
use crate::program::Program;

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
