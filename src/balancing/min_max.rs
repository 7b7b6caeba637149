//! Min-max and limited weights: a search from the inside, and a proof of how far from the optimum it ended.
//!
//! A residual within `t` and a weight within its limit are second-order cones. The barriers `-ln(t^2 - |r|^2)` and
//! `-ln(L^2 - |w|^2)` keep the search inside (Boyd and Vandenberghe, *Convex Optimization*, 11.6); each step is
//! Newton's. The Hessian of a cone's barrier has an explicit root, so its rows go through rotations into a triangle,
//! and no product of a matrix with itself is formed.
//!
//! The proof: for any `lambda >= 0` of sum one and any `mu >= 0`, the least squares
//! `min sum lambda |r|^2 + sum mu (|w|^2 - L^2)` are a lower bound of the square of the optimum (weak duality). The
//! barriers give lambda and mu, the factorisation of [`super::qr`] the bound.

use nalgebra::ComplexField;

use super::aim::{Aim, Objective};
use super::influence::Influence;
use super::matrix::{pick, put};
use super::qr::{PivotedQr, Qr};
use super::scalar::{Complex, Scalar, real, size, square, zero};

/// Real and imaginary part of each weight, and the bound `t` of the residuals.
#[derive(Clone, Copy)]
struct Wide<T, const PLANES: usize> {
    weights: [[T; 2]; PLANES],
    bound: T,
}

impl<T: Scalar, const PLANES: usize> Wide<T, PLANES> {
    fn new() -> Self {
        Wide { weights: [[T::zero(); 2]; PLANES], bound: T::zero() }
    }

    fn at(&self, index: usize) -> T {
        match self.weights.get(index / 2) {
            Some([re, im]) => {
                if index.is_multiple_of(2) {
                    *re
                } else {
                    *im
                }
            }
            None => self.bound,
        }
    }

    fn at_mut(&mut self, index: usize) -> &mut T {
        match self.weights.get_mut(index / 2) {
            Some([re, im]) => {
                if index.is_multiple_of(2) {
                    re
                } else {
                    im
                }
            }
            None => &mut self.bound,
        }
    }
}

/// The triangle of the rows of a Hessian's root.
struct Root<T, const PLANES: usize> {
    rows: [[Wide<T, PLANES>; 2]; PLANES],
    last: Wide<T, PLANES>,
}

impl<T: Scalar, const PLANES: usize> Root<T, PLANES> {
    fn row(&mut self, index: usize) -> &mut Wide<T, PLANES> {
        match self.rows.get_mut(index / 2) {
            Some([re, im]) => {
                if index.is_multiple_of(2) {
                    re
                } else {
                    im
                }
            }
            None => &mut self.last,
        }
    }

    /// Takes in a row; `free` are the indices in use.
    fn absorb(&mut self, mut new: Wide<T, PLANES>, free: impl Iterator<Item = usize> + Clone) {
        let mut rest = free;
        while let Some(k) = rest.next() {
            let out = new.at(k);
            if out == T::zero() {
                continue;
            }
            let row = self.row(k);
            let radius = Complex { re: row.at(k), im: out }.modulus();
            let (c, s) = (row.at(k) / radius, out / radius);
            *row.at_mut(k) = radius;
            for j in rest.clone() {
                let (x, y) = (row.at(j), new.at(j));
                *row.at_mut(j) = c * x + s * y;
                *new.at_mut(j) = c * y - s * x;
            }
        }
    }

    /// `-H^-1 g` for `H = R^T R`, and the decrement, the root of `g^T H^-1 g`.
    fn step(
        &mut self,
        gradient: &Wide<T, PLANES>,
        free: impl DoubleEndedIterator<Item = usize> + Clone,
    ) -> (Wide<T, PLANES>, T) {
        let mut y = Wide::<T, PLANES>::new();
        let mut square = T::zero();
        for k in free.clone() {
            let mut sum = -gradient.at(k);
            for j in free.clone().take_while(|&j| j < k) {
                sum -= self.row(j).at(k) * y.at(j);
            }
            let value = sum / self.row(k).at(k);
            *y.at_mut(k) = value;
            square += value * value;
        }
        let mut p = Wide::<T, PLANES>::new();
        for k in free.clone().rev() {
            let mut sum = y.at(k);
            for j in free.clone().rev().take_while(|&j| j > k) {
                sum -= self.row(k).at(j) * p.at(j);
            }
            *p.at_mut(k) = sum / self.row(k).at(k);
        }
        (p, square.sqrt())
    }
}

/// A plane with a limit: the limit, its square less the weight's, the weight searched about and the weight, all in the
/// search's unit.
struct Limited<T: Scalar> {
    plane: usize,
    limit: T,
    inside: T,
    centre: Complex<T>,
    weight: Complex<T>,
}

/// A problem about the weights found so far: its columns have norm one, its residuals are of the size of one.
///
/// The optimum may be a millionth of the vibration. Counted from zero weights, its residuals would be differences of
/// numbers a million times as large; so both are counted from a centre that follows the search.
pub(super) struct Search<'p, T: Scalar, const ROWS: usize, const PLANES: usize> {
    influence: &'p Influence<T, ROWS, PLANES>,
    vibration: &'p [Complex<T>],
    aim: &'p Aim<T, ROWS, PLANES>,
    rows: usize,
    /// The planes that are searched.
    used: [bool; PLANES],
    /// The weighted influence, each column over its norm.
    a: [[Complex<T>; PLANES]; ROWS],
    norms: [T; PLANES],
    /// The weights that are searched about.
    centre: [Complex<T>; PLANES],
    /// The weighted residual with them, over the unit.
    b: [Complex<T>; ROWS],
    /// The largest residual with them.
    unit: T,
}

/// Weights found, with the proof of their distance from the optimum.
pub(super) struct Found<T: Scalar, const PLANES: usize> {
    pub(super) weights: [Complex<T>; PLANES],
    /// Lower bound of the objective.
    pub(super) below: T,
    /// The objective with these weights.
    pub(super) reached: T,
}

impl<'p, T: Scalar, const ROWS: usize, const PLANES: usize> Search<'p, T, ROWS, PLANES> {
    pub(super) fn new(
        influence: &'p Influence<T, ROWS, PLANES>,
        vibration: &'p [Complex<T>],
        aim: &'p Aim<T, ROWS, PLANES>,
        pivoted: &PivotedQr<T, PLANES>,
    ) -> Self {
        let mut search = Search {
            influence,
            vibration,
            aim,
            rows: influence.rows(),
            used: [false; PLANES],
            a: [[zero(); PLANES]; ROWS],
            norms: [T::one(); PLANES],
            centre: [zero(); PLANES],
            b: [zero(); ROWS],
            unit: T::one(),
        };
        for (row, a) in search.a.iter_mut().enumerate().take(influence.rows()) {
            *a = influence.row(row, vibration, &aim.weighting).0;
        }
        for &plane in pivoted.order.iter().take(pivoted.rank) {
            let norm = search.a.iter().fold(T::zero(), |norm, row| norm.max(size(pick(row, plane, zero()))));
            put(&mut search.used, plane, true);
            put(&mut search.norms, plane, norm);
        }
        for a in &mut search.a {
            for ((a, used), norm) in a.iter_mut().zip(&search.used).zip(&search.norms) {
                *a = if *used { a.unscale(*norm) } else { zero() };
            }
        }
        search
    }

    fn free(&self) -> impl DoubleEndedIterator<Item = usize> + Clone + '_ {
        let bound = self.aim.objective == Objective::MinMax;
        (0..=2 * PLANES).filter(move |&index| pick(&self.used, index / 2, bound))
    }

    fn residual(&self, row: usize, at: &Wide<T, PLANES>) -> Complex<T> {
        let mut sum = pick(&self.b, row, zero());
        for (a, [re, im]) in self.a.get(row).into_iter().flatten().zip(&at.weights) {
            sum += *a * Complex { re: *re, im: *im };
        }
        sum
    }

    /// Counts from other weights from now on.
    fn centre(&mut self, weights: &[Complex<T>; PLANES]) {
        self.centre = *weights;
        let residuals = self.influence.weighted(self.vibration, weights, &self.aim.weighting);
        let largest = residuals.iter().fold(T::zero(), |most, residual| most.max(size(*residual)));
        self.unit = if largest > T::zero() { largest } else { T::one() };
        self.b = residuals.map(|residual| residual.unscale(self.unit));
    }

    /// The weights at a point, none beyond its limit by rounding.
    fn weights(&self, at: &Wide<T, PLANES>) -> [Complex<T>; PLANES] {
        let mut weights = self.centre;
        let parts = weights.iter_mut().zip(&at.weights).zip(self.norms.iter().zip(&self.aim.limits));
        for ((weight, [re, im]), (norm, limit)) in parts {
            *weight += Complex { re: *re, im: *im }.scale(self.unit / *norm);
            if let Some(limit) = limit.filter(|limit| size(*weight) > *limit) {
                *weight = weight.scale(limit * (T::one() - T::default_epsilon() * real(4.0)) / size(*weight));
            }
        }
        weights
    }

    /// The objective at a point: the largest residual, or the sum of their squares.
    fn value(&self, at: &Wide<T, PLANES>) -> T {
        let residuals = (0..self.rows).map(|row| self.residual(row, at));
        match self.aim.objective {
            Objective::MinMax => residuals.fold(T::zero(), |most, residual| most.max(size(residual))),
            Objective::LeastSquares => residuals.fold(T::zero(), |sum, residual| sum + square(residual)),
        }
    }

    /// Whether a point is within all cones.
    fn within(&self, at: &Wide<T, PLANES>) -> bool {
        let below = |row| size(self.residual(row, at)) < at.bound;
        (self.aim.objective == Objective::LeastSquares || (0..self.rows).all(below))
            && self.limited(at).all(|limited| limited.inside > T::zero())
    }

    /// Searches from weights near the optimum: the best weights found, and the best lower bound.
    pub(super) fn run(mut self, start: &[Complex<T>; PLANES]) -> Found<T, PLANES> {
        let mut weights = [zero(); PLANES];
        let mut cones = if self.aim.objective == Objective::MinMax { 2 * self.rows } else { 0 };
        for (plane, (weight, start)) in weights.iter_mut().zip(start).enumerate() {
            if !pick(&self.used, plane, false) {
                continue;
            }
            *weight = *start;
            if let Some(limit) = pick(&self.aim.limits, plane, None) {
                cones += 1;
                let far = limit * real(0.9);
                if size(*weight) > far {
                    *weight = weight.scale(far / size(*weight));
                }
            }
        }
        self.centre(&weights);
        let mut at = Wide::new();
        at.bound = self.value(&at) * real(1.2);
        let mut found = Found { weights, below: T::zero(), reached: self.reached(&at) };
        let mut tau = real::<T>(cones as f64) / self.value(&at).max(T::default_epsilon());
        let mut idle = 0;
        for _ in 0..60 {
            if !self.follow(&mut at, tau) {
                break;
            }
            let (below, reached) = (self.below(&at, tau) * self.unit, self.reached(&at));
            let gap = found.reached - found.below;
            found.below = found.below.max(below);
            if reached < found.reached {
                (found.reached, found.weights) = (reached, self.weights(&at));
            }
            let left = found.reached - found.below;
            if left <= found.reached * real(T::CLOSE) {
                break;
            }
            // the gap shrinks by eight a round, until rounding ends that
            idle = if left < gap * real(0.5) { 0 } else { idle + 1 };
            if idle > 4 {
                break;
            }
            tau *= real(8.0);
            if reached < self.unit * real(0.1) {
                (at, tau) = self.recentred(&at, tau);
                if !self.within(&at) {
                    break;
                }
            }
        }
        found
    }

    /// The same point of the same path, counted from its weights from now on: `tau` times the objective stays.
    fn recentred(&mut self, at: &Wide<T, PLANES>, tau: T) -> (Wide<T, PLANES>, T) {
        let before = self.unit;
        let weights = self.weights(at);
        self.centre(&weights);
        let grown = before / self.unit;
        let tau = tau / if self.aim.objective == Objective::MinMax { grown } else { grown * grown };
        (Wide { bound: at.bound * grown, ..Wide::new() }, tau)
    }

    /// Newton's steps to the middle of the path; false where rounding allows no step.
    fn follow(&self, at: &mut Wide<T, PLANES>, tau: T) -> bool {
        let mut last = T::max_value().unwrap_or(T::one());
        for _ in 0..60 {
            let (step, decrement) = self.newton(at, tau);
            if !decrement.is_finite() {
                return false;
            }
            // near the middle the decrement is squared by each step, until rounding ends that
            if decrement < real(0.25) && decrement > last * real(0.5) {
                return true;
            }
            last = decrement;
            let mut share = if decrement > real(0.25) { T::one() / (T::one() + decrement) } else { T::one() };
            let moved = |share: T| {
                let mut to = *at;
                for index in self.free() {
                    *to.at_mut(index) += share * step.at(index);
                }
                to
            };
            // a step of that length ends inside, but for rounding
            while !self.within(&moved(share)) {
                share *= real(0.5);
                if !(share > real(1e-3)) {
                    return false;
                }
            }
            *at = moved(share);
            if decrement < real(1e-3) {
                return true;
            }
        }
        true
    }

    /// The objective at a point, in the unit of the readings.
    fn reached(&self, at: &Wide<T, PLANES>) -> T {
        match self.aim.objective {
            Objective::MinMax => self.value(at) * self.unit,
            Objective::LeastSquares => self.value(at).sqrt() * self.unit,
        }
    }

    /// The planes with a limit.
    fn limited<'s>(&'s self, at: &'s Wide<T, PLANES>) -> impl Iterator<Item = Limited<T>> + 's {
        let limits = self.aim.limits.iter().zip(&self.used).zip(&at.weights).enumerate();
        limits.filter_map(|(plane, ((limit, used), [x, y]))| {
            let scale = pick(&self.norms, plane, T::one()) / self.unit;
            let (limit, centre) = ((*limit).filter(|_| *used)?, pick(&self.centre, plane, zero()));
            let (left, from) = ((limit - size(centre)) * scale, centre.scale(scale));
            let limit = limit * scale;
            // L^2 - |c + d|^2 without the difference of the large squares
            let inside = left * (limit + size(from)) - (*x * (from.re + from.re + *x) + *y * (from.im + from.im + *y));
            Some(Limited { plane, limit, inside, centre: from, weight: from + Complex { re: *x, im: *y } })
        })
    }

    /// Newton's step of `tau` times the objective and the barriers.
    fn newton(&self, at: &Wide<T, PLANES>, tau: T) -> (Wide<T, PLANES>, T) {
        let two = real::<T>(2.0);
        let mut root = Root { rows: [[Wide::new(); 2]; PLANES], last: Wide::new() };
        let mut gradient = Wide::new();
        if self.aim.objective == Objective::MinMax {
            gradient.bound = tau;
        }
        for row in 0..self.rows {
            let r = self.residual(row, at);
            // rows of the change of the residual's real and imaginary part
            let (mut re, mut im) = (Wide::new(), Wide::new());
            let parts = re.weights.iter_mut().zip(&mut im.weights);
            for ((re, im), a) in parts.zip(self.a.get(row).into_iter().flatten()) {
                *re = [a.re, -a.im];
                *im = [a.im, a.re];
            }
            let pull = match self.aim.objective {
                Objective::LeastSquares => {
                    let factor = (two * tau).sqrt();
                    for part in [re, im] {
                        root.absorb(combined([(factor, part)]), self.free());
                    }
                    two * tau
                }
                Objective::MinMax => {
                    let t = at.bound;
                    let length = size(r);
                    let inside = (t - length) * (t + length);
                    let mut bound = Wide::new();
                    bound.bound = T::one();
                    // the root of 2 w w^T - J for w = (t, -r)/sqrt(t^2 - |r|^2), whose hyperbolic length is one
                    let norm = inside.sqrt();
                    let (w0, w1, w2) = (t / norm, -r.re / norm, -r.im / norm);
                    let factor = (two / inside).sqrt();
                    let bent = T::one() / (T::one() + w0);
                    let rows = [
                        [w0, w1, w2],
                        [w1, T::one() + w1 * w1 * bent, w1 * w2 * bent],
                        [w2, w1 * w2 * bent, T::one() + w2 * w2 * bent],
                    ];
                    for [x, y, z] in rows {
                        root.absorb(combined([(factor * x, bound), (factor * y, re), (factor * z, im)]), self.free());
                    }
                    gradient.bound -= two * t / inside;
                    two / inside
                }
            };
            for index in 0..2 * PLANES {
                *gradient.at_mut(index) += pull * (r.re * re.at(index) + r.im * im.at(index));
            }
        }
        for Limited { plane, inside, weight, .. } in self.limited(at) {
            let Complex { re: x, im: y } = weight;
            let length = size(weight);
            let factor = (two / inside).sqrt();
            // the root of I + 2 w w^T/inside: longer along w by a factor
            let along = (T::one() + two * length * length / inside).sqrt() - T::one();
            let (ex, ey) = if length > T::zero() { (x / length, y / length) } else { (T::zero(), T::zero()) };
            let rows = [[T::one() + along * ex * ex, along * ex * ey], [along * ex * ey, T::one() + along * ey * ey]];
            for [a, b] in rows {
                let mut row = Wide::new();
                put(&mut row.weights, plane, [factor * a, factor * b]);
                root.absorb(row, self.free());
            }
            *gradient.at_mut(2 * plane) += two * x / inside;
            *gradient.at_mut(2 * plane + 1) += two * y / inside;
        }
        root.step(&gradient, self.free())
    }

    /// Lower bound of the objective by the barriers' multipliers.
    fn below(&self, at: &Wide<T, PLANES>, tau: T) -> T {
        let mut qr = Qr::<T, PLANES>::new();
        let mut shares = [T::one(); ROWS];
        let mut whole = tau;
        if self.aim.objective == Objective::MinMax {
            whole = T::zero();
            for (row, share) in shares.iter_mut().enumerate().take(self.rows) {
                let length = size(self.residual(row, at));
                *share = T::one() / ((at.bound - length) * (at.bound + length));
                whole += *share;
            }
            shares = shares.map(|share| share / whole);
        }
        for ((a, b), share) in self.a.iter().zip(&self.b).zip(&shares).take(self.rows) {
            let root = share.sqrt();
            qr.absorb(&a.map(|a| a.scale(root)), -b.scale(root));
        }
        let mut squares = T::zero();
        for Limited { plane, limit, inside, centre, .. } in self.limited(at) {
            let mu = T::one() / (inside * whole);
            let mut a = [zero(); PLANES];
            put(&mut a, plane, Complex { re: mu.sqrt(), im: T::zero() });
            qr.absorb(&a, -centre.scale(mu.sqrt()));
            squares -= mu * limit * limit;
        }
        (squares + qr.rest).max(T::zero()).sqrt()
    }
}

/// A sum of rows times factors.
fn combined<T: Scalar, const PLANES: usize, const K: usize>(parts: [(T, Wide<T, PLANES>); K]) -> Wide<T, PLANES> {
    let mut sum = Wide::new();
    for (factor, part) in parts {
        for index in 0..=2 * PLANES {
            *sum.at_mut(index) += factor * part.at(index);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
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
                let slope =
                    (8.0 * (f(&[(i, h)]) - f(&[(i, -h)])) - (f(&[(i, 2.0 * h)]) - f(&[(i, -2.0 * h)]))) / 12.0 / h;
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
                assert!(
                    (held.modulus() / (limit * share.min(1.0)) - 1.0).abs() < 1e-15 * 4.0 && held.modulus() <= limit
                );
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
            let a =
                |row: usize, plane: usize| problem.influence.get(row, plane).unwrap().scale(problem.aim.weighting[row]);
            let v = |row: usize| problem.vibration[row].scale(problem.aim.weighting[row]);
            let dot = |p: usize, q: usize| {
                (0..ROWS).map(|row| a(row, p).conj() * a(row, q) * lambda[row]).sum::<Complex<f64>>()
            };
            let right = |p: usize| (0..ROWS).map(|row| a(row, p).conj() * v(row) * lambda[row]).sum::<Complex<f64>>();
            let (m00, m11, m01) = (dot(0, 0) + mu[0], dot(1, 1) + mu[1], dot(0, 1));
            let determinant = m00 * m11 - m01 * m01.conj();
            let w = [
                -(m11 * right(0) - m01 * right(1)) / determinant,
                -(m00 * right(1) - m01.conj() * right(0)) / determinant,
            ];
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

    /// Rows go into the triangle, and the step solves its normal equations: seven rows of five numbers, some of them
    /// zero, with all of them in use and without the last.
    #[test]
    fn the_triangle_solves_its_normal_equations() {
        let mut noise = Noise::new(3);
        for used in [5, 4] {
            let mut root = Root::<f64, 2> { rows: [[Wide::new(); 2]; 2], last: Wide::new() };
            let mut hessian = [[0.0; 5]; 5];
            for row in 0..7 {
                let mut wide = Wide::new();
                for k in 0..5 {
                    *wide.at_mut(k) = if row % 3 == k % 3 { 0.0 } else { noise.even() };
                }
                for (i, line) in hessian.iter_mut().enumerate() {
                    for (j, value) in line.iter_mut().enumerate() {
                        *value += wide.at(i) * wide.at(j);
                    }
                }
                root.absorb(wide, 0..used);
            }
            let mut gradient = Wide::new();
            for k in 0..5 {
                *gradient.at_mut(k) = noise.even();
            }
            let (step, decrement) = root.step(&gradient, 0..used);
            let mut product = 0.0;
            for (k, line) in hessian.iter().enumerate().take(used) {
                let sum: f64 = line.iter().enumerate().take(used).map(|(j, value)| value * step.at(j)).sum();
                assert!((sum + gradient.at(k)).abs() < 1e-13, "{used}, {k}");
                product -= gradient.at(k) * step.at(k);
            }
            assert!((product.sqrt() / decrement - 1.0).abs() < 1e-12);
        }
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
}
