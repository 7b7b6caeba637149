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

/// What a point is worth, whether it is within the cones, and its weights.
#[test]
fn a_point_is_its_weights() {
    for (problem, centre, point) in problems() {
        let search = problem.search(&centre);
        let (weights, residuals) = problem.at(&search, &point);
        let largest = residuals.iter().fold(0.0_f64, |most, residual| most.max(residual.modulus()));
        let squares: f64 = residuals.iter().map(|residual| residual.norm_sqr()).sum();
        // the unit is the largest residual of the centre
        let (_, at_centre) = problem.at(&search, &Wide::new());
        let unit = at_centre.iter().fold(0.0_f64, |most, residual| most.max(residual.modulus()));
        assert!((search.unit / unit - 1.0).abs() < 1e-14);
        let min_max = problem.aim.objective == Objective::MinMax;
        let reached = if min_max { largest } else { squares.sqrt() };
        assert!((search.reached(&point) / reached - 1.0).abs() < 1e-12);
        let value = if min_max { largest / search.unit } else { squares / search.unit / search.unit };
        assert!((search.value(&point) / value - 1.0).abs() < 1e-12);
        for (found, expected) in search.weights(&point).iter().zip(&weights) {
            assert!((*found - *expected).modulus() < 1e-14);
        }
        for limited in search.limited(&point) {
            let limit = problem.aim.limits[limited.plane].unwrap();
            let scale = search.norms[limited.plane] / search.unit;
            let weight = weights[limited.plane];
            let inside = (limit * limit - weight.norm_sqr()) * scale * scale;
            assert!((limited.inside / inside - 1.0).abs() < 1e-12);
            assert!((limited.limit / (limit * scale) - 1.0).abs() < 1e-14);
            assert!((limited.weight - weight.scale(scale)).modulus() < 1e-13);
        }
        assert!(search.within(&point));
        let mut narrow = point;
        narrow.bound = largest / search.unit * 0.999;
        assert_eq!(search.within(&narrow), !min_max);
        narrow.bound = largest / search.unit * 1.001;
        assert!(search.within(&narrow));
        // the second plane to just beyond its limit, and its weights then to within it
        let (limit, scale) = (problem.aim.limits[1].unwrap(), search.norms[1] / search.unit);
        for (share, within) in [(0.999, true), (1.001, false)] {
            let mut far = point;
            far.bound = 1e3;
            let to = Complex { re: 0.6, im: -0.8 }.scale(limit * share) - centre[1];
            far.weights[1] = [to.re * scale, to.im * scale];
            assert_eq!(search.within(&far), within);
            let held = search.weights(&far)[1];
            // four units in the last place below it
            assert!((held.modulus() / (limit * share.min(1.0)) - 1.0).abs() < 1e-15 * 4.0 && held.modulus() <= limit);
            assert!((held.argument() - (-0.8_f64).atan2(0.6)).abs() < 1e-14);
        }
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

/// Of `tau |1 + w|^2` the decrement is `lambda = |1 + w| root(2 tau)`: above a quarter a step takes it to
/// `lambda^2/(1 + lambda)`, below to zero. After sixty steps the way ends where it is.
#[test]
fn the_way_to_the_middle_of_squares() {
    plane([1.0], [1.0], &Aim::default(), |search| {
        let mut sixty = 1000.0;
        for _ in 0..60 {
            sixty = sixty * sixty / (1.0 + sixty);
        }
        for (decrement, expected) in [(0.24, 0.0), (0.26, 0.0), (3.0, 0.0), (1000.0, sixty)] {
            let mut at = Wide::new();
            assert!(search.follow(&mut at, 0.5 * decrement * decrement));
            let left = search.value(&at).sqrt() * decrement;
            // rounding of sixty steps
            assert!((left - expected).abs() < 1e-12 * decrement, "{decrement}: {left} {expected}");
        }
        // no number leads nowhere
        assert!(!search.follow(&mut Wide::new(), f64::NAN));
    });
}

/// Of `tau |1 + w|^2 - ln(1 - w^2)` the slope at -1/2 is `tau - 4/3`. The way begins at no weight, which has no
/// direction.
#[test]
fn the_way_to_the_middle_below_a_limit() {
    plane([1.0], [1.0], &Aim { limits: [Some(1.0)], ..Aim::default() }, |search| {
        let mut at = Wide::new();
        assert!(search.follow(&mut at, 4.0 / 3.0));
        // the last decrement is below a thousandth, and what it leaves is of its square
        assert!((at.at(0) + 0.5).abs() < 1e-6 && at.at(1) == 0.0, "{:?}", at.weights);
    });
}

/// Another centre is the same point of the same path: Newton's decrement knows no unit.
#[test]
fn a_point_may_be_counted_from_itself() {
    for (problem, centre, point) in problems() {
        let mut search = problem.search(&centre);
        let ((weights, residuals), decrement) = (problem.at(&search, &point), search.newton(&point, 3.0).1);
        let bound = point.bound * search.unit;
        let (at, tau) = search.recentred(&point, 3.0);
        // rounding of some operations on numbers of the order of one
        assert!((at.bound * search.unit / bound - 1.0).abs() < 1e-13);
        let (same, left) = problem.at(&search, &at);
        assert!(same.iter().zip(&weights).all(|(same, weight)| (*same - *weight).modulus() < 1e-13));
        assert!(left.iter().zip(&residuals).all(|(left, residual)| (*left - *residual).modulus() < 1e-13));
        assert_eq!(at.weights, [[0.0; 2]; PLANES]);
        assert!((search.newton(&at, tau).1 / decrement - 1.0).abs() < 1e-11);
    }
}

/// Readings of 1 and -1 on either side are the best, at no weight, and a third one of 1/2 that no weight changes
/// has its share of the bound: at the middle `tau = 4t/(t^2 - 1) + 2t/(t^2 - 1/4)`, and the bound is
/// `root(t^2 - 6t/tau)`, so the gap is `1/tau` but for its square. It begins at twice the cones over the largest
/// reading, 6, and falls by eight a round until it is below 1e-10 of that: 8^11 rounds later.
#[test]
fn the_gap_of_a_search_falls_by_eight() {
    let aim = Aim { objective: Objective::MinMax, ..Aim::default() };
    plane([1.0, -1.0, 0.0], [1.0, 1.0, 0.5], &aim, |search| {
        let found = search.run(&[Complex { re: 0.0, im: 0.0 }]);
        assert_eq!((found.reached, found.weights[0].modulus()), (1.0, 0.0));
        let gap = 1.0 / (6.0 * 8.0_f64.powi(11));
        // rounding of one is 1e-5 of it
        assert!(((1.0 - found.below) / gap - 1.0).abs() < 1e-3, "{:e} {gap:e}", 1.0 - found.below);
    });
}

/// Two readings of 5 and 4 and a weight of 2 at most: the squares `(5 + w)^2 + (4 + w)^2` are least at -2, 13. The
/// search begins at nine tenths of the limit, where they are 15.08. In the middle the bound's square is the squares
/// less one over `tau`, in the readings' unit, so the gap is half of that over the root of 13. `tau` begins at one
/// over the squares, and 8^11 of it are enough for 1e-10.
#[test]
fn the_gap_at_a_limit() {
    plane([1.0, 1.0], [5.0, 4.0], &Aim { limits: [Some(2.0)], ..Aim::default() }, |search| {
        let found = search.run(&[Complex { re: -4.5, im: 0.0 }]);
        let least = 13.0_f64.sqrt();
        assert!((found.reached / least - 1.0).abs() < 1e-10 && found.reached > least, "{}", found.reached);
        let gap = 15.08 / (2.0 * least * 8.0_f64.powi(11));
        // rounding of the root of 13 is 2e-6 of it
        assert!(((found.reached - found.below) / gap - 1.0).abs() < 1e-3, "{:e}", found.reached - found.below);
    });
}

/// The square of a limit of 1e-200 is zero: the search ends where it begins, at a start within the limit or at nine
/// tenths of it.
#[test]
fn a_search_begins_inside() {
    plane([1.0], [5.0], &Aim { limits: [Some(1e-200)], ..Aim::default() }, |search| {
        let found = search.run(&[Complex { re: 3.0, im: -4.0 }]);
        assert!((found.weights[0].scale(1e200) - Complex { re: 0.54, im: -0.72 }).modulus() < 1e-15);
        assert_eq!((found.below, found.reached), (0.0, 5.0));
    });
    plane([1.0], [5.0], &Aim { limits: [Some(1e-200)], ..Aim::default() }, |search| {
        let start = Complex { re: 0.5e-200, im: 0.7e-200 };
        assert_eq!(search.run(&[start]).weights[0], start);
    });
}

/// Readings of 1 and 2^-30 on either side of a weight within 1.05: the search begins at 0.945, and the best is
/// 2^-30, 2e-8 of the unit there. In that unit no bound within 1e-10 of it is a number of double precision.
#[test]
fn a_small_optimum_has_a_small_unit() {
    let left = 1.0 / 1_073_741_824.0;
    let aim = Aim { objective: Objective::MinMax, limits: [Some(1.05)], ..Aim::default() };
    plane([1.0, 1.0], [1.0 + left, 1.0 - left], &aim, |search| {
        let found = search.run(&[Complex { re: -1.0, im: 0.0 }]);
        // rounding of one, twice
        assert!((found.reached - left).abs() <= 2.0 * f64::EPSILON, "{:e}", found.reached);
        assert!(found.below <= found.reached && found.below > left * (1.0 - 1e-6), "{:e}", found.below);
    });
}

/// Of `tau t - 2 ln t`, with residuals of zero, a step squares `e = 1 - tau t/2` and the decrement is `e root(2)`:
/// from a tenth the third step is the first one below a thousandth, and the last.
#[test]
fn the_way_ends_near_the_middle() {
    let aim = Aim { objective: Objective::MinMax, ..Aim::default() };
    plane([1.0], [0.0], &aim, |search| {
        let mut at = Wide { bound: 0.9, ..Wide::new() };
        assert!(search.follow(&mut at, 2.0));
        // rounding of one
        assert!((1.0 - at.bound - 1e-8).abs() < 1e-15, "{:e}", 1.0 - at.bound);
    });
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
