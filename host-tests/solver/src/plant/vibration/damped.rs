//! Damped eigenvalues, all of them at once, by the iteration of Ehrlich and Aberth.

use nalgebra::{Complex, DMatrix, Schur};

use super::elimination::Elimination;
use super::number::{Complexes, Dual, Number};
use super::{Modes, Network};
use crate::plant::error::PlantError;

/// Eigenvalues that are iterated side by side.
const SIDE_BY_SIDE: usize = 4;

/// Most coordinates whose whole matrix is looked at.
const DENSE: usize = 200;

/// Most steps. Six are usual; a cluster takes one for each digit of its distance.
const STEPS: usize = 400;

/// Steps after which a pair of conjugates that has not settled may part further from the real axis.
const PATIENCE: usize = 30;

/// Share of its size below which the imaginary part of a pair may be that of two decays without vibration.
const PARTING: f64 = 1e-3;

/// Step over its size below which an iterate settles once its steps shrink no more.
const HELD: f64 = 1e-10;

/// Share of its size below which a part of an eigenvalue is rounding.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// A damped vibration, or a decay without one: an eigenvalue `-decay + i omega`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Decay {
    /// 1/s; below zero where the motion grows.
    pub decay: f64,
    /// rad/s, zero or above.
    pub omega: f64,
}

impl Decay {
    /// Damping ratio: 1 of a decay without vibration.
    #[must_use]
    pub fn damping_ratio(&self) -> f64 {
        self.decay / self.decay.hypot(self.omega)
    }
}

/// An eigenvalue on its way.
#[derive(Clone, Copy)]
struct Iterate {
    at: Complex<f64>,
    /// Whether its conjugate is one too.
    paired: bool,
    /// Whether its imaginary part is held at zero.
    real: bool,
    settled: bool,
    /// Size of the last step.
    step: f64,
}

impl Iterate {
    fn new(at: Complex<f64>, paired: bool) -> Self {
        Self { at, paired, real: false, settled: false, step: f64::INFINITY }
    }

    /// Two alone in place of a pair, apart from each other and from the real axis.
    fn part(&mut self) -> Self {
        let (at, size) = (self.at, self.at.norm());
        *self = Self::new(Complex::new(1.1 * at.re, at.im.max(0.02 * size)), false);
        Self::new(Complex::new(0.9 * at.re, -at.im.max(0.03 * size)), false)
    }
}

impl Network {
    /// Damped vibrations and decays, the slowest first, one of each conjugate pair, from the undamped modes: as many
    /// as those have, of a network without shafts of their own inertia all. None of what neither swings nor decays.
    ///
    /// # Errors
    /// [`PlantError::Count`] where the iteration does not settle, or misses an eigenvalue.
    pub fn decays(&self, modes: &Modes) -> Result<Vec<Decay>, PlantError> {
        if !self.is_damped() {
            return Ok(modes.omega.iter().map(|&omega| Decay { decay: 0.0, omega }).collect());
        }
        let top = modes.omega.last().copied().unwrap_or(0.0);
        let cut = self.cut(top);
        let still = self.free(|link| link.stiffness > 0.0 || link.damping > 0.0, |at| at.viscous != 0.0);
        let zeros = modes.rigid_motions + still;
        let mut all: Vec<Iterate> = Vec::new();
        // Decays of even shafts crowd at stiffness over damping: further ones than these stand less than 1e-3 apart.
        let aside = if self.is_distributed() { 1e-6 } else { 1e-3 };
        for (m, (&omega, &dissipation)) in modes.omega.iter().zip(&modes.dissipation).enumerate() {
            let half = 0.5 * dissipation;
            // no two alike, none on the real axis: two that stand together hold each other
            let apart = Complex::new(1.0 + aside * (m as f64 * 0.618_034).fract(), aside);
            if half.abs() < omega {
                let at = Complex::new(-half, ((omega - half) * (omega + half)).sqrt());
                all.push(Iterate::new(apart * at, true));
            } else {
                let fast = half.abs() + ((half - omega) * (half + omega)).sqrt().abs().max(1e-3 * omega);
                all.push(Iterate::new(apart * -fast.copysign(half), false));
                all.push(Iterate::new(apart.conj() * -(omega * omega / fast).copysign(half), false));
            }
        }
        // what springs leave free and dampers brake
        let total: f64 = self.coordinates.iter().map(|at| at.inertia).sum();
        let mut rates: Vec<f64> = self.rates();
        rates.sort_by(|a, b| b.abs().total_cmp(&a.abs()));
        for k in 0..modes.rigid_motions.saturating_sub(still) {
            let rate = rates.get(k).copied().filter(|rate| *rate != 0.0).unwrap_or(1.0 / total.max(f64::MIN_POSITIVE));
            all.push(Iterate::new(Complex::new(-rate, 1e-3 * rate * (1.0 + k as f64)), false));
        }
        let count = 2 * modes.omega.len() + modes.rigid_motions - still;
        let found = self.settle(&cut, zeros, &mut all).and_then(|()| self.check(modes, &all));
        if let Err(error) = found {
            // from afar some may stand where nothing is: from the eigenvalues of the whole matrix, where it is small
            all = self.dense(count).ok_or(error)?;
            self.settle(&cut, zeros, &mut all)?;
            self.check(modes, &all)?;
        }
        let mut decays: Vec<Decay> = all
            .iter()
            .filter(|one| one.at.im >= 0.0)
            .map(|one| {
                let kept = |part: f64| if part.abs() > ROUNDING * one.at.norm() { part } else { 0.0 };
                Decay { decay: -kept(one.at.re), omega: kept(one.at.im) }
            })
            .collect();
        decays.sort_by(|a, b| a.decay.hypot(a.omega).total_cmp(&b.decay.hypot(b.omega)));
        Ok(decays)
    }

    /// The largest eigenvalues of the equations in `sqrt(J) v` and `sqrt(k) x`, so many, to the rounding of the largest;
    /// none of large networks.
    fn dense(&self, count: usize) -> Option<Vec<Iterate>> {
        let n = self.size();
        if n > DENSE || self.is_distributed() {
            return None;
        }
        let root: Vec<f64> = self.coordinates.iter().map(|at| at.inertia.sqrt()).collect();
        let mut state = DMatrix::zeros(n + self.links.len(), n + self.links.len());
        for (j, at) in self.coordinates.iter().enumerate() {
            state[(j, j)] = -at.viscous / at.inertia;
        }
        for (row, link) in (n..).zip(&self.links) {
            for &(at, share) in &link.terms {
                let strain = share * link.stiffness.sqrt() / root[at];
                (state[(row, at)], state[(at, row)]) = (strain, -strain);
                for &(other, theirs) in &link.terms {
                    state[(at, other)] -= share * theirs * link.damping / (root[at] * root[other]);
                }
            }
        }
        // far more steps than the two or three of an eigenvalue
        let values = Schur::try_new(state, f64::EPSILON, 10_000)?.complex_eigenvalues();
        let mut values: Vec<Complex<f64>> = values.iter().copied().collect();
        values.sort_by(|a, b| b.norm().total_cmp(&a.norm()));
        values.truncate(count);
        let start = |at: Complex<f64>| Iterate { real: at.im == 0.0, ..Iterate::new(at, at.im > 0.0) };
        Some(values.into_iter().filter(|at| at.im >= 0.0).map(start).collect())
    }

    /// Damping over inertia of each coordinate (1/s).
    fn rates(&self) -> Vec<f64> {
        let mut rates: Vec<f64> = self.coordinates.iter().map(|at| at.viscous).collect();
        for link in &self.links {
            link.terms.iter().for_each(|&(at, share)| rates[at] += share * share * link.damping);
        }
        let over = |(rate, at): (&f64, &super::Coordinate)| rate / at.inertia;
        rates.iter().zip(&self.coordinates).map(over).collect()
    }

    /// The sum of all eigenvalues is that of the rates.
    fn check(&self, modes: &Modes, all: &[Iterate]) -> Result<(), PlantError> {
        if self.is_distributed() || modes.omega.len() + modes.rigid_motions < self.size() {
            return Ok(());
        }
        let each = |one: &Iterate| one.at.re * if one.paired { 2.0 } else { 1.0 };
        let (sum, size) = (all.iter().map(each).sum::<f64>(), all.iter().map(|one| one.at.norm()).sum::<f64>());
        let trace: f64 = self.rates().iter().sum();
        if (sum + trace).abs() <= 1e-8 * (size + trace.abs()) {
            return Ok(());
        }
        Err(PlantError::Count { name: "eigenvalues found", found: 0, expected: all.len() })
    }

    fn settle(&self, cut: &Self, zeros: usize, all: &mut Vec<Iterate>) -> Result<(), PlantError> {
        let elimination = Elimination::of(cut);
        let mut factors = Vec::new();
        for step in 0..STEPS {
            let waiting: Vec<usize> = (0..all.len()).filter(|&i| !all[i].settled).collect();
            if waiting.is_empty() {
                return Ok(());
            }
            for batch in waiting.chunks(SIDE_BY_SIDE) {
                let at: [Complex<f64>; SIDE_BY_SIDE] = std::array::from_fn(|l| all[batch[l.min(batch.len() - 1)]].at);
                let log = cut.log_derivative(&elimination, at, &mut factors);
                for (&i, log) in batch.iter().zip(log) {
                    let log = log - zeros as f64 / all[i].at;
                    advance(all, i, log);
                }
            }
            for i in 0..all.len() {
                let one = all[i];
                let near = if !one.settled && step == PATIENCE { 0.1 } else { PARTING };
                if one.paired && !one.settled && one.at.im < near * one.at.norm() {
                    let other = all[i].part();
                    all.push(other);
                } else if !one.paired && !one.real && one.settled && one.at.im.abs() < 1e-7 * one.at.norm() {
                    // two conjugates that stand beside the axis part along it
                    all[i] = Iterate { real: true, ..Iterate::new((one.at.re + one.at.im).into(), false) };
                }
            }
        }
        let found = all.iter().filter(|one| one.settled).count();
        Err(PlantError::Count { name: "eigenvalues found", found, expected: all.len() })
    }

    /// `f'/f` of the determinant of the equations of motion at several shifts: the sum of that of the pivots, less
    /// that of the links' compliances.
    fn log_derivative<const L: usize>(
        &self,
        elimination: &Elimination,
        at: [Complex<f64>; L],
        factors: &mut Vec<Dual<L>>,
    ) -> [Complex<f64>; L] {
        let value = Complexes { re: at.map(|at| at.re), im: at.map(|at| at.im) };
        let shift = Dual { value, slope: Complexes::real(1.0) };
        self.diagonal(shift, shift.times(shift), factors);
        let own = |dual: &Dual<L>| dual.slope.times(dual.value.inverse());
        let mut sum = Complexes::<L>::ZERO;
        for (link, value) in self.links.iter().zip(&factors[self.coordinates.len()..]) {
            if link.damping > 0.0 || link.inertia > 0.0 {
                sum = sum.minus(own(value));
            }
        }
        elimination.run(factors, |pivot, inverse| {
            sum = sum.plus(pivot.slope.times(inverse.value));
            for l in 0..L {
                // without a number: this shift cannot be eliminated in this order
                if pivot.value.re[l] == 0.0 && pivot.value.im[l] == 0.0 {
                    sum.re[l] = f64::NAN;
                }
            }
        });
        std::array::from_fn(|l| Complex::new(sum.re[l], sum.im[l]))
    }
}

/// One step of an iterate, away from the others.
fn advance(all: &mut [Iterate], i: usize, log: Complex<f64>) {
    let one = all[i];
    let mut others = Complex::from(0.0);
    for (j, other) in all.iter().enumerate() {
        if j != i {
            others += apart(one.at - other.at);
        }
        if other.paired {
            others += apart(one.at - other.at.conj());
        }
    }
    let mut step = (log - others).inv();
    if one.real {
        step.im = 0.0;
    }
    let size = one.at.norm();
    let is_nudged = !step.is_finite();
    if is_nudged {
        step = one.at * 1e-13;
    } else if step.norm() > size {
        // far from all eigenvalues a step may be of any size
        step *= size / step.norm();
    }
    // two that stand together far from any eigenvalue hold each other
    if step.norm() < HELD * size && log.norm() * HELD.sqrt() * size < 1.0 {
        step = one.at * (1e-3 * (1.0 + (i as f64 * 0.618_034).fract()));
    }
    let moved = step.norm();
    // a pivot that is exactly zero where the steps were small already is that of the eigenvalue
    let is_found = is_nudged && one.step < HELD * size;
    let small = moved <= 16.0 * f64::EPSILON * size || (moved < HELD * size && moved >= 0.5 * one.step);
    all[i] = Iterate {
        at: if is_found { one.at } else { one.at - step },
        step: if is_nudged { f64::INFINITY } else { moved },
        settled: is_found || (small && !is_nudged),
        ..one
    };
}

/// The inverse of a difference; zero of none.
fn apart(difference: Complex<f64>) -> Complex<f64> {
    let square = difference.norm_sqr();
    if square > 0.0 { difference.conj() / square } else { Complex::from(0.0) }
}
