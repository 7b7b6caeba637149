//! One linear stretch: the matrices that hold while contacts, stops and flows of power stay as they are.

use nalgebra::{DMatrix, SymmetricEigen};

use super::chain::Chain;
use super::dense::Dense;
use super::exponential::Propagator;
use super::layout::Layout;
use super::mode::Mode;

/// Steps kept per regime; a run of one tick length needs one.
const STEPS_KEPT: usize = 4;

/// `x' = A x + B f`, with `f` the torques on the nodes.
#[derive(Debug, Clone)]
pub(super) struct Regime {
    pub a: Dense,
    pub b: Dense,
    /// Square root of twice the energy per unit of state; zero where a state stores none.
    pub energy: Vec<f64>,
    /// Bound of the growth of the energy norm, 1/s: zero unless a gear loss or the motor feeds the motion.
    pub growth: f64,
    /// Bound of every rate of the regime, 1/s: the highest natural frequency when undamped.
    pub rate: f64,
    balance: Vec<f64>,
    steps: Vec<Propagator>,
    last_step: f64,
}

impl Regime {
    pub fn new(chain: &Chain, mode: &Mode) -> Self {
        let n = chain.nodes.len();
        let layout = Layout { nodes: n };
        let m = layout.states();
        let (mut a, mut b) = (Dense::zeros(m, m), Dense::zeros(m, n));
        let mut energy = vec![0.0; m];
        let mut balance = vec![1.0; m];
        for (j, node) in chain.nodes.iter().enumerate() {
            let speed = layout.speed(j);
            let slope = if j == 0 { chain.law.slope() } else { 0.0 };
            a.add(speed, speed, -(node.viscous + slope) / node.inertia);
            b.set(speed, j, 1.0 / node.inertia);
            energy[speed] = node.inertia.sqrt();
            balance[speed] = energy[speed];
        }
        for (s, shaft) in chain.shafts.iter().enumerate() {
            let (front, back) = (layout.speed(s), layout.speed(s + 1));
            a.set(s, front, 1.0);
            a.set(s, back, -1.0);
            balance[s] = shaft.stiffness.sqrt();
            if !mode.carries(chain, s) {
                continue;
            }
            energy[s] = balance[s];
            let torque = [(s, shaft.stiffness), (front, shaft.damping), (back, -shaft.damping)];
            for (column, factor) in torque {
                a.add(front, column, -mode.loss(chain, s) * factor / chain.nodes[s].inertia);
                a.add(back, column, factor / chain.nodes[s + 1].inertia);
            }
        }
        a.set(layout.angle(), layout.speed(0), 1.0);
        // a held speed is zero: it neither changes nor moves anything
        for j in (0..n).filter(|&j| mode.is_held(j)) {
            a.clear_row(layout.speed(j));
            a.clear_column(layout.speed(j));
            b.clear_row(layout.speed(j));
        }
        balance[layout.angle()] = balance[layout.speed(0)];
        let (growth, rate) = energy_bounds(&a, &energy);
        balance[layout.angle()] *= if rate > 0.0 { rate } else { 1.0 };
        Self { a, b, energy, growth, rate, balance, steps: Vec::new(), last_step: 0.0 }
    }

    /// The exact step of this length, made when the same length is used a second time running.
    pub fn step_of(&mut self, step: f64) -> Option<&Propagator> {
        let known = self.steps.iter().position(|kept| kept.step == step);
        let again = self.last_step == step;
        self.last_step = step;
        let index = match known {
            Some(index) => index,
            None if again => {
                if self.steps.len() == STEPS_KEPT {
                    self.steps.remove(0);
                }
                let made = Propagator::new(&self.a, &self.b, &self.balance, self.rate, step);
                self.steps.push(made);
                self.steps.len() - 1
            }
            None => return None,
        };
        self.steps.get(index)
    }
}

/// Largest eigenvalue of the symmetric part, not below zero, and the spectral norm of `A` in energy coordinates.
fn energy_bounds(a: &Dense, energy: &[f64]) -> (f64, f64) {
    let kept: Vec<usize> = (0..energy.len()).filter(|&i| energy[i] > 0.0).collect();
    let scaled =
        DMatrix::from_fn(kept.len(), kept.len(), |r, c| a.get(kept[r], kept[c]) * energy[kept[r]] / energy[kept[c]]);
    let symmetric = (&scaled + scaled.transpose()) * 0.5;
    let growth = SymmetricEigen::new(symmetric).eigenvalues.max().max(0.0);
    let norm = SymmetricEigen::new(scaled.transpose() * &scaled).eigenvalues.max().max(0.0).sqrt();
    // rounding of the eigenvalues must not undercut the bounds
    let slack = 1e-12 * norm;
    (growth + slack, norm + slack)
}
