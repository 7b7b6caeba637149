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

mod root;

use nalgebra::ComplexField;

use super::aim::{Aim, Objective};
use super::influence::Influence;
use super::matrix::{pick, put};
use super::qr::{PivotedQr, Qr};
use super::scalar::{Complex, Scalar, real, size, square, zero};
use root::{Root, Wide, combined};

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
        let mut root = Root::new();
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

#[cfg(test)]
mod tests;
