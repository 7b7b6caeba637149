//! The exact step of the whirling rotor over a tick, at any speed of a run.
//!
//! `x' = A(Omega) x + B f(t)` is propagated by `exp(A h)` and by the integrals of a cubic through `f` at four instants
//! of the tick.
//! The exponentials are computed at speeds on a grid when they are first needed; at a speed between them the step is
//! that of the square through the nearest three, which is off by `(2 h D)^3/16` at most, `D` the grid's spacing: `G` is
//! at most 2 per rad/s in modal coordinates.
//!
//! Where the speed changes within a tick the step is Magnus's to the fourth order, `exp(h A(mean) + h^3/12 Omega' [G,
//! A])`, the second term by its first power on either side [Blanes et al. 2009, Phys. Rep. 470, 151-238].

use std::collections::BTreeMap;

use nalgebra::{Complex, DMatrix, DVector};

use super::modal::Modal;
use super::spin::Turn;
use crate::exponential::exponential;

/// Instants of the tick at which the force is taken, as shares.
pub(super) const INSTANTS: [f64; 4] = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0];

/// Largest `2 h D`: (4e-4)^3/16 is 4e-12.
const SPACING: f64 = 4e-4;

/// `[exp(A h) | W]`: what state and forces at the four instants become.
type Step = DMatrix<f64>;

#[derive(Clone, Debug)]
pub(super) struct Steps {
    modal: Modal,
    /// Duration of a tick (s).
    pub tick: f64,
    spacing: f64,
    known: BTreeMap<i64, Step>,
    /// `[dA/dOmega, A]` and `dA/dOmega B`.
    commutator: DMatrix<f64>,
    input_rate: DMatrix<f64>,
}

impl Steps {
    pub fn new(modal: Modal, tick: f64, spacing: Option<f64>) -> Self {
        let spacing = spacing.unwrap_or(SPACING / (2.0 * tick));
        let (a, per_speed) = (modal.system(0.0), modal.system(1.0) - modal.system(0.0));
        let commutator = &per_speed * &a - &a * &per_speed;
        let input_rate = per_speed * modal.input();
        Steps { modal, tick, spacing, known: BTreeMap::new(), commutator, input_rate }
    }

    pub fn modal(&self) -> &Modal {
        &self.modal
    }

    /// `x` after a turn; `forces` are those at the instants, one after another.
    pub fn apply(&mut self, turn: &Turn, x: &DVector<f64>, forces: &[f64]) -> DVector<f64> {
        let mean = (turn.end_angle - turn.angle) / turn.duration;
        let gain = (turn.end_speed - turn.speed) * self.tick * self.tick / 24.0;
        if gain == 0.0 {
            return self.at(mean, x, forces);
        }
        let m = self.input_rate.ncols();
        let middle = DVector::from_fn(m, |j, _| 0.5 * (forces[m + j] + forces[2 * m + j]));
        let constant = &self.input_rate * middle * gain;
        let mut before = x + &constant;
        before.gemv(gain, &self.commutator, x, 1.0);
        let mut after = self.at(mean, &before, forces);
        let change = &self.commutator * &after * gain + constant;
        after += change;
        after
    }

    /// The same at a constant speed.
    fn at(&mut self, speed: f64, x: &DVector<f64>, forces: &[f64]) -> DVector<f64> {
        let place = speed / self.spacing;
        let middle = place.round();
        let off = place - middle;
        let mut operand = DVector::zeros(x.len() + forces.len());
        operand.rows_mut(0, x.len()).copy_from(x);
        operand.rows_mut(x.len(), forces.len()).copy_from_slice(forces);
        let middle = middle as i64;
        if off.abs() < 1e-9 {
            return self.step(middle) * operand;
        }
        let weights = [(-1, 0.5 * off * (off - 1.0)), (0, 1.0 - off * off), (1, 0.5 * off * (off + 1.0))];
        let mut sum = DVector::zeros(x.len());
        for (beside, weight) in weights {
            sum.gemv(weight, self.step(middle + beside), &operand, 1.0);
        }
        sum
    }

    fn step(&mut self, index: i64) -> &Step {
        let Steps { modal, tick, spacing, known, .. } = self;
        known.entry(index).or_insert_with(|| step(modal, index as f64 * *spacing, *tick))
    }
}

fn step(modal: &Modal, speed: f64, h: f64) -> Step {
    let (a, b) = (modal.system(speed), modal.input());
    let (n, m) = (a.nrows(), b.ncols());
    // f = sum c_k s^k, s = t/h: a chain of integrators in front of the rotor
    let mut whole = DMatrix::zeros(n + 4 * m, n + 4 * m);
    whole.view_mut((0, 0), (n, n)).copy_from(&(a * h));
    whole.view_mut((0, n), (n, m)).copy_from(&(b * h));
    for k in 0..3 {
        whole.view_mut((n + k * m, n + (k + 1) * m), (m, m)).fill_with_identity();
    }
    let e = exponential(&whole);
    // the chain's states are k! c_k, the coefficients c = V^-1 f of Vandermonde's matrix of the instants
    let vandermonde = nalgebra::Matrix4::from_fn(|row, k| INSTANTS[row].powi(k as i32));
    let inverse = vandermonde.try_inverse().unwrap_or_else(nalgebra::Matrix4::zeros);
    let factorial = [1.0, 1.0, 2.0, 6.0];
    let mut step = DMatrix::zeros(n, n + 4 * m);
    step.view_mut((0, 0), (n, n)).copy_from(&e.view((0, 0), (n, n)));
    for instant in 0..4 {
        for k in 0..4 {
            let by = factorial[k] * inverse[(k, instant)];
            let part = e.view((0, n + k * m), (n, m)) * by;
            let mut block = step.view_mut((0, n + instant * m), (n, m));
            block += part;
        }
    }
    step
}

/// `(Omega^2 - i Omega') exp(i phi)`: force per unbalance.
pub(super) fn force_per_unbalance((angle, speed, rate): (f64, f64, f64)) -> Complex<f64> {
    Complex::new(speed * speed, -rate) * Complex::from_polar(1.0, angle)
}
