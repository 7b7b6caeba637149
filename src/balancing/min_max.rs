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

/// A problem whose rows and columns are brought to the size of one.
pub(super) struct Search<T: Scalar, const ROWS: usize, const PLANES: usize> {
    objective: Objective,
    rows: usize,
    /// The planes that are searched.
    used: [bool; PLANES],
    a: [[Complex<T>; PLANES]; ROWS],
    b: [Complex<T>; ROWS],
    limits: [Option<T>; PLANES],
    /// Scale of the weights.
    scale: [T; PLANES],
    /// Scale of the rows.
    unit: T,
}

impl<T: Scalar, const ROWS: usize, const PLANES: usize> Search<T, ROWS, PLANES> {
    pub(super) fn new(
        influence: &Influence<T, ROWS, PLANES>,
        vibration: &[Complex<T>],
        aim: &Aim<T, ROWS, PLANES>,
        pivoted: &PivotedQr<T, PLANES>,
    ) -> Self {
        let mut search = Search {
            objective: aim.objective,
            rows: influence.rows(),
            used: [false; PLANES],
            a: [[zero(); PLANES]; ROWS],
            b: [zero(); ROWS],
            limits: [None; PLANES],
            scale: [T::one(); PLANES],
            unit: T::one(),
        };
        let mut largest = T::zero();
        let rows = search.rows;
        for (row, (a, b)) in search.a.iter_mut().zip(&mut search.b).enumerate().take(rows) {
            (*a, *b) = influence.row(row, vibration, &aim.weighting);
            largest = largest.max(size(*b));
        }
        if largest > T::zero() {
            search.unit = largest;
        }
        for &plane in pivoted.order.iter().take(pivoted.rank) {
            let norm = search.a.iter().fold(T::zero(), |norm, row| norm.max(size(pick(row, plane, zero()))));
            let scale = norm / search.unit;
            put(&mut search.used, plane, true);
            put(&mut search.scale, plane, scale);
            put(&mut search.limits, plane, pick(&aim.limits, plane, None).map(|limit| limit * scale));
        }
        for (a, b) in search.a.iter_mut().zip(&mut search.b) {
            *b = b.unscale(search.unit);
            for ((a, used), scale) in a.iter_mut().zip(&search.used).zip(&search.scale) {
                *a = if *used { a.unscale(search.unit * *scale) } else { zero() };
            }
        }
        search
    }

    fn free(&self) -> impl DoubleEndedIterator<Item = usize> + Clone + '_ {
        let bound = self.objective == Objective::MinMax;
        (0..=2 * PLANES).filter(move |&index| pick(&self.used, index / 2, bound))
    }

    fn residual(&self, row: usize, at: &Wide<T, PLANES>) -> Complex<T> {
        let mut sum = pick(&self.b, row, zero());
        for (a, [re, im]) in self.a.get(row).into_iter().flatten().zip(&at.weights) {
            sum += *a * Complex { re: *re, im: *im };
        }
        sum
    }

    /// Searches from weights near the optimum: the weights found, and the lower bound of the objective. `None` where
    /// that is too far.
    pub(super) fn run(&self, start: &[Complex<T>; PLANES]) -> Option<([Complex<T>; PLANES], T)> {
        let mut at = Wide::new();
        let mut cones = if self.objective == Objective::MinMax { 2 * self.rows } else { 0 };
        for (plane, (at, start)) in at.weights.iter_mut().zip(start).enumerate() {
            let mut weight = start.scale(pick(&self.scale, plane, T::one()));
            if !pick(&self.used, plane, false) {
                continue;
            }
            if let Some(limit) = pick(&self.limits, plane, None) {
                cones += 1;
                let far = limit * real(0.9);
                if size(weight) > far {
                    weight = weight.scale(far / size(weight));
                }
            }
            *at = [weight.re, weight.im];
        }
        let value = |at: &Wide<T, PLANES>| match self.objective {
            Objective::MinMax => (0..self.rows).fold(T::zero(), |most, row| most.max(size(self.residual(row, at)))),
            Objective::LeastSquares => (0..self.rows).fold(T::zero(), |sum, row| sum + square(self.residual(row, at))),
        };
        at.bound = value(&at) * real(1.2);
        let parameter = real::<T>(cones as f64);
        let mut tau = parameter / value(&at).max(T::default_epsilon());
        for _ in 0..40 {
            for _ in 0..60 {
                let (step, decrement) = self.newton(&at, tau);
                if !decrement.is_finite() {
                    return None;
                }
                let share = if decrement > real(0.25) { T::one() / (T::one() + decrement) } else { T::one() };
                for index in self.free() {
                    *at.at_mut(index) += share * step.at(index);
                }
                if decrement < real(1e-3) {
                    break;
                }
            }
            if parameter / tau < value(&at) * real(T::CLOSE) {
                break;
            }
            tau *= real(8.0);
        }
        let below = self.below(&at, tau);
        let reached = match self.objective {
            Objective::MinMax => value(&at),
            Objective::LeastSquares => value(&at).sqrt(),
        };
        // ten thousand times the aim in double precision, a hundred times in single: the accuracy promised to the
        // caller
        if !(reached - below <= reached * real::<T>(T::CLOSE).max(real(1e-8)) * real(100.0)) {
            return None;
        }
        let mut weights = [zero(); PLANES];
        for ((weight, [re, im]), scale) in weights.iter_mut().zip(&at.weights).zip(&self.scale) {
            *weight = Complex { re: *re, im: *im }.unscale(*scale);
        }
        Some((weights, below * self.unit))
    }

    /// The planes with a limit, their limits and weights.
    fn limited<'s>(&'s self, at: &'s Wide<T, PLANES>) -> impl Iterator<Item = (usize, T, [T; 2])> + 's {
        let limits = self.limits.iter().zip(&self.used).zip(&at.weights).enumerate();
        limits.filter_map(|(plane, ((limit, used), weight))| Some((plane, (*limit).filter(|_| *used)?, *weight)))
    }

    /// Newton's step of `tau` times the objective and the barriers.
    fn newton(&self, at: &Wide<T, PLANES>, tau: T) -> (Wide<T, PLANES>, T) {
        let two = real::<T>(2.0);
        let mut root = Root { rows: [[Wide::new(); 2]; PLANES], last: Wide::new() };
        let mut gradient = Wide::new();
        if self.objective == Objective::MinMax {
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
            let pull = match self.objective {
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
        for (plane, limit, [x, y]) in self.limited(at) {
            let length = Complex { re: x, im: y }.modulus();
            let inside = (limit - length) * (limit + length);
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
        let two = real::<T>(2.0);
        let mut qr = Qr::<T, PLANES>::new();
        let mut shares = [T::one(); ROWS];
        let mut whole = T::one();
        let mut force = T::one() / tau;
        if self.objective == Objective::MinMax {
            force = two * at.bound / tau;
            whole = T::zero();
            for (row, share) in shares.iter_mut().enumerate().take(self.rows) {
                let length = size(self.residual(row, at));
                *share = force / ((at.bound - length) * (at.bound + length));
                whole += *share;
            }
        }
        for ((a, b), share) in self.a.iter().zip(&self.b).zip(&shares).take(self.rows) {
            let root = (*share / whole).sqrt();
            qr.absorb(&a.map(|a| a.scale(root)), -b.scale(root));
        }
        let mut squares = T::zero();
        for (plane, limit, [re, im]) in self.limited(at) {
            let length = Complex { re, im }.modulus();
            let mu = force / ((limit - length) * (limit + length)) / whole;
            let mut a = [zero(); PLANES];
            put(&mut a, plane, Complex { re: mu.sqrt(), im: T::zero() });
            qr.absorb(&a, zero());
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
