//! The search's points, steps and bounds against the formulas that they stand for, and how searches end.

extern crate std;

use std::vec::Vec;

use super::*;
use crate::balancing::scalar::noise::Noise;

/// Five readings, three planes of which the second has a limit and the last is out of use.
const ROWS: usize = 5;
const PLANES: usize = 3;

struct Problem {
    influence: Influence<f64, ROWS, PLANES>,
    vibration: [Complex<f64>; ROWS],
    aim: Aim<f64, ROWS, PLANES>,
}

impl Problem {
    fn new(seed: u64, objective: Objective, limits: [Option<f64>; PLANES]) -> Self {
        let mut noise = Noise::new(seed);
        let mut influence = Influence::new(ROWS, PLANES).unwrap();
        for plane in 0..PLANES {
            // the last plane is the first one again: out of use
            let column = [(); ROWS].map(|()| noise.complex().scale((plane + 1) as f64));
            influence.set(plane, &column).unwrap();
        }
        let first = core::array::from_fn::<_, ROWS, _>(|row| influence.get(row, 0).unwrap());
        influence.set(PLANES - 1, &first).unwrap();
        let mut aim = Aim { objective, limits, ..Aim::default() };
        aim.weighting = [1.0, 0.5, 2.0, 1.0, 1.5];
        Problem { influence, vibration: [(); ROWS].map(|()| noise.complex()), aim }
    }

    fn search(&self, centre: &[Complex<f64>; PLANES]) -> Search<'_, f64, ROWS, PLANES> {
        let qr = self.influence.qr(&self.vibration, &self.aim.weighting);
        let mut search = Search::new(&self.influence, &self.vibration, &self.aim, &qr.pivoted(0.01));
        search.centre(centre);
        search
    }

    /// The weights that a point stands for, and their weighted residuals, from the influence itself.
    fn at(
        &self,
        search: &Search<'_, f64, ROWS, PLANES>,
        point: &Wide<f64, PLANES>,
    ) -> ([Complex<f64>; PLANES], [Complex<f64>; ROWS]) {
        let weights = core::array::from_fn(|plane| {
            let [re, im] = point.weights[plane];
            search.centre[plane] + Complex { re, im }.scale(search.unit / search.norms[plane])
        });
        let predicted = self.influence.predict(&self.vibration, &weights).unwrap();
        (weights, core::array::from_fn(|row| predicted[row].scale(self.aim.weighting[row])))
    }

    /// `tau` times the objective and the barriers of the text, all over the search's unit.
    fn barrier(&self, search: &Search<'_, f64, ROWS, PLANES>, point: &Wide<f64, PLANES>, tau: f64) -> f64 {
        let (weights, residuals) = self.at(search, point);
        let residuals = residuals.map(|residual| residual.norm_sqr() / search.unit / search.unit);
        let mut sum = match self.aim.objective {
            Objective::LeastSquares => tau * residuals.iter().sum::<f64>(),
            Objective::MinMax => {
                let cones = residuals.iter().map(|square| -(point.bound * point.bound - square).ln());
                tau * point.bound + cones.sum::<f64>()
            }
        };
        for (weight, limit) in weights.iter().zip(&self.aim.limits) {
            if let Some(limit) = limit {
                sum -= (limit * limit - weight.norm_sqr()).ln();
            }
        }
        sum
    }
}

/// Both objectives, with limits and without, at a point beside a centre.
fn problems() -> impl Iterator<Item = (Problem, [Complex<f64>; PLANES], Wide<f64, PLANES>)> {
    (1..=6).map(|seed| {
        let objective = if seed % 2 == 0 { Objective::MinMax } else { Objective::LeastSquares };
        let limits = if seed < 5 { [None, Some(0.9), None] } else { [Some(1.2), Some(0.8), None] };
        let problem = Problem::new(seed, objective, limits);
        let mut noise = Noise::new(100 + seed);
        let mut centre = [(); PLANES].map(|()| noise.complex().scale(0.4));
        centre[PLANES - 1] = Complex { re: 0.0, im: 0.0 };
        let mut point = Wide::new();
        for weight in &mut point.weights[..PLANES - 1] {
            *weight = [0.2 * noise.even(), 0.1 * noise.even()];
        }
        point.bound = 2.5;
        (problem, centre, point)
    })
}

/// The Hessian times the step is the gradient's opposite, both by differences of the barriers as they are written
/// in the text, and the decrement's square is the gradient times the step.
#[test]
fn newtons_step_is_that_of_the_barriers() {
    for (problem, centre, point) in problems() {
        let search = problem.search(&centre);
        let free: Vec<usize> = search.free().collect();
        // the bound, where there is one, and the two planes in use
        assert_eq!(free.len(), if problem.aim.objective == Objective::MinMax { 5 } else { 4 });
        let tau = 3.0;
        let (step, decrement) = search.newton(&point, tau);
        let f = |moves: &[(usize, f64)]| {
            let mut moved = point;
            for (index, by) in moves {
                *moved.at_mut(*index) += by;
            }
            problem.barrier(&search, &moved, tau)
        };
        let h = 1e-3;
        let mut product = 0.0;
        for &i in &free {
            // differences of the fourth order: h^4 of the sixth derivative
            let slope = (8.0 * (f(&[(i, h)]) - f(&[(i, -h)])) - (f(&[(i, 2.0 * h)]) - f(&[(i, -2.0 * h)]))) / 12.0 / h;
            let curved = |j: usize, h: f64| {
                (f(&[(i, h), (j, h)]) - f(&[(i, h), (j, -h)]) - f(&[(i, -h), (j, h)]) + f(&[(i, -h), (j, -h)]))
                    / (4.0 * h * h)
            };
            let row = free.iter().map(|&j| (4.0 * curved(j, h) - curved(j, 2.0 * h)) / 3.0 * step.at(j));
            let left = row.sum::<f64>() + slope;
            // the differences' own error
            assert!(left.abs() < 1e-5 * (1.0 + slope.abs()), "{i}: {left} of {slope}");
            product -= slope * step.at(i);
        }
        assert!((product.sqrt() / decrement - 1.0).abs() < 1e-6, "{product} {decrement}");
    }
}

/// The lower bound is that of weak duality at the barriers' multipliers, `1/(t^2 - |r|^2)` over their sum and
/// `1/(L^2 - |w|^2)` over the same, or over `tau`: the least squares by the normal equations of two planes, in the
/// readings' own unit.
#[test]
fn the_lower_bound_is_the_dual_one() {
    let mut shown = [0; 2];
    for (problem, centre, mut point) in problems() {
        let search = problem.search(&centre);
        let tau = 300.0;
        let (weights, residuals) = problem.at(&search, &point);
        point.bound =
            1.001 * residuals.iter().fold(0.0_f64, |most, residual| most.max(residual.modulus() / search.unit));
        let min_max = problem.aim.objective == Objective::MinMax;
        let bound = point.bound * search.unit;
        let mut lambda = [1.0; ROWS];
        // d/dw of tau |r|^2/unit^2 is -d/dw ln: the multiplier over tau, in the unit of the readings
        let mut sum = tau / search.unit / search.unit;
        if min_max {
            lambda = residuals.map(|residual| 1.0 / (bound * bound - residual.norm_sqr()));
            sum = lambda.iter().sum();
            lambda = lambda.map(|lambda| lambda / sum);
        }
        let mu: [f64; PLANES] = core::array::from_fn(|plane| match problem.aim.limits[plane] {
            Some(limit) => 1.0 / (limit * limit - weights[plane].norm_sqr()) / sum,
            None => 0.0,
        });
        // A^H L A + M, and A^H L v, of the first two planes
        let a = |row: usize, plane: usize| problem.influence.get(row, plane).unwrap().scale(problem.aim.weighting[row]);
        let v = |row: usize| problem.vibration[row].scale(problem.aim.weighting[row]);
        let dot =
            |p: usize, q: usize| (0..ROWS).map(|row| a(row, p).conj() * a(row, q) * lambda[row]).sum::<Complex<f64>>();
        let right = |p: usize| (0..ROWS).map(|row| a(row, p).conj() * v(row) * lambda[row]).sum::<Complex<f64>>();
        let (m00, m11, m01) = (dot(0, 0) + mu[0], dot(1, 1) + mu[1], dot(0, 1));
        let determinant = m00 * m11 - m01 * m01.conj();
        let w =
            [-(m11 * right(0) - m01 * right(1)) / determinant, -(m00 * right(1) - m01.conj() * right(0)) / determinant];
        let mut least = 0.0;
        for (row, lambda) in lambda.iter().enumerate() {
            least += lambda * (v(row) + a(row, 0) * w[0] + a(row, 1) * w[1]).norm_sqr();
        }
        for plane in 0..2 {
            let limit = problem.aim.limits[plane].unwrap_or(0.0);
            least += mu[plane] * (w[plane].norm_sqr() - limit * limit);
        }
        let below = search.below(&point, tau) * search.unit;
        if least < 0.0 {
            assert_eq!(below, 0.0);
            continue;
        }
        shown[usize::from(min_max)] += 1;
        assert!((below / least.sqrt() - 1.0).abs() < 1e-10, "{below} {}", least.sqrt());
    }
    // a bound of zero shows nothing
    assert!(shown[0] > 1 && shown[1] > 1, "{shown:?}");
}

/// Of one plane, with these coefficients and readings.
fn plane<const ROWS: usize>(
    coefficients: [f64; ROWS],
    vibration: [f64; ROWS],
    aim: &Aim<f64, ROWS, 1>,
    with: impl FnOnce(Search<'_, f64, ROWS, 1>),
) {
    let mut influence = Influence::<f64, ROWS, 1>::new(ROWS, 1).unwrap();
    let complex = |re: f64| Complex { re, im: 0.0 };
    influence.set(0, &coefficients.map(complex)).unwrap();
    let vibration = vibration.map(complex);
    let pivoted = influence.qr(&vibration, &aim.weighting).pivoted(0.01);
    let mut search = Search::new(&influence, &vibration, aim, &pivoted);
    search.centre(&[complex(0.0)]);
    with(search);
}

/// Readings of one on either side allow no bound below one. The middle is at `1 + 2/tau`, which is one in double
/// precision: the way ends at the next larger number, where a step of two thirds of the difference is halved. For a
/// larger `tau` the step is too short to be halved.
#[test]
fn the_way_ends_inside() {
    let aim = Aim { objective: Objective::MinMax, ..Aim::default() };
    plane([1.0, -1.0], [1.0; 2], &aim, |search| {
        for (tau, is_near) in [(1e17, true), (1e40, false)] {
            let mut at = Wide { bound: 1.5, ..Wide::new() };
            assert_eq!(search.follow(&mut at, tau), is_near);
            assert_eq!(at.bound, 1.0 + f64::EPSILON);
        }
    });
}
