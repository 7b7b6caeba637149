//! Guards: the quantities that must not fall below zero while a linear stretch lasts.

use super::chain::Chain;
use super::dense::dot;
use super::layout::Layout;
use super::mode::{FREE, Mode, TRAILING, elastic_torque};
use super::regime::Regime;

/// Action of a fallen guard.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Action {
    /// The contact of the shaft becomes this.
    Contact(usize, i8),
    /// The node has come to rest.
    Stop(usize),
    /// The held node breaks loose in this direction.
    Slip(usize, i8),
    /// The torque of the shaft changes its sign.
    Flow(usize),
}

/// `row x + force f + constant >= 0`, with `f` the outer torques on the nodes.
#[derive(Debug, Clone)]
pub(super) struct Guard {
    pub action: Action,
    pub row: Vec<f64>,
    pub force: Vec<f64>,
    pub constant: f64,
    /// Bound of the second derivative per unit of the energy norm of `x'`; infinite where there is none.
    bend: f64,
    input: Vec<f64>,
}

/// Bounds of a tick with which the guards pass it without a closer check.
pub(super) struct Tick<'a> {
    pub before: &'a [f64],
    pub after: &'a [f64],
    pub rate_before: &'a [f64],
    pub force_before: &'a [f64],
    pub force_after: &'a [f64],
    /// Change of the outer torques per second; empty when they are held.
    pub force_rate: &'a [f64],
    /// Bound of the energy norm of `x'` over the tick.
    pub rate_norm: f64,
    pub length: f64,
}

impl Guard {
    fn new(regime: &Regime, action: Action, row: Vec<f64>, force: Vec<f64>, constant: f64) -> Self {
        let slope = regime.a.left_times(&row);
        let input = regime.b.left_times(&row);
        let share = |(s, e): (&f64, &f64)| match (*s == 0.0, *e == 0.0) {
            (true, _) => 0.0,
            (false, true) => f64::INFINITY,
            (false, false) => (s / e).powi(2),
        };
        let bend = slope.iter().zip(&regime.energy).map(share).sum::<f64>().sqrt();
        Self { action, row, force, constant, bend, input }
    }

    pub fn value(&self, x: &[f64], force: &[f64]) -> f64 {
        dot(&self.row, x) + dot(&self.force, force) + self.constant
    }

    /// True if the guard certainly stays above zero all through the tick.
    pub fn passes(&self, tick: &Tick) -> bool {
        let h = tick.length;
        let (a, b) = (self.value(tick.before, tick.force_before), self.value(tick.after, tick.force_after));
        if !(a >= 0.0 && b > 0.0) {
            return false;
        }
        let bend = self.bend * tick.rate_norm + dot(&self.input, tick.force_rate).abs();
        if a.min(b) > 0.125 * bend * h * h {
            return true;
        }
        let pull = dot(&self.force, tick.force_rate);
        dot(&self.row, tick.rate_before) + pull > bend * h
    }
}

pub(super) fn guards(chain: &Chain, mode: &Mode, regime: &Regime, coulomb: &[f64]) -> Vec<Guard> {
    let layout = Layout { nodes: chain.nodes.len() };
    let (m, n) = (layout.states(), layout.nodes);
    let mut found = Vec::new();
    let mut add = |action, row: Vec<f64>, force: Vec<f64>, constant| {
        found.push(Guard::new(regime, action, row, force, constant));
    };
    let idle = || vec![0.0; n];
    for (s, shaft) in chain.shafts.iter().enumerate() {
        if shaft.is_linear() {
            continue;
        }
        let twist = |sign: f64| {
            let mut row = vec![0.0; m];
            row[s] = sign;
            row
        };
        let reach = shaft.origin(1);
        let contact = mode.contact[s];
        let side = f64::from(contact.signum());
        let torque = |sign: f64| {
            let mut closed = mode.clone();
            closed.contact[s] = contact.signum();
            let (row, constant) = elastic_torque(chain, &closed, s);
            (row.iter().map(|v| sign * v).collect::<Vec<f64>>(), sign * constant)
        };
        match contact.abs() {
            0 => {
                add(Action::Contact(s, 1), twist(-1.0), idle(), reach);
                if !shaft.rope {
                    add(Action::Contact(s, -1), twist(1.0), idle(), reach);
                }
            }
            1 => {
                let left = if shaft.damping > 0.0 { contact * TRAILING } else { 0 };
                let (row, constant) = torque(side);
                add(Action::Contact(s, left), row, idle(), constant);
            }
            _ => {
                let (row, constant) = torque(-side);
                add(Action::Contact(s, contact.signum()), row, idle(), constant);
                add(Action::Contact(s, 0), twist(side), idle(), -reach);
            }
        }
    }
    for j in (0..n).filter(|&j| mode.motion[j] != FREE) {
        let direction = f64::from(mode.motion[j]);
        if mode.motion[j] != 0 {
            let mut row = vec![0.0; m];
            row[layout.speed(j)] = direction;
            add(Action::Stop(j), row, idle(), 0.0);
            continue;
        }
        for side in [1.0, -1.0] {
            let (row, force, constant) = hold(chain, mode, j, side);
            add(Action::Slip(j, side as i8), row, force, constant + coulomb[j]);
        }
    }
    for s in 0..chain.shafts.len() {
        // a contact carries one sign alone
        if chain.nodes[s].is_lossy() && chain.shafts[s].is_linear() {
            let (row, constant) = elastic_torque(chain, mode, s);
            let sign = f64::from(mode.flow[s]);
            add(Action::Flow(s), row.iter().map(|v| v * sign).collect(), idle(), constant * sign);
        }
    }
    found
}

/// How far the push on a held node is from breaking it loose towards `side`, less the dry friction.
fn hold(chain: &Chain, mode: &Mode, node: usize, side: f64) -> (Vec<f64>, Vec<f64>, f64) {
    let n = chain.nodes.len();
    let mut row = vec![0.0; 2 * n];
    let mut force = vec![0.0; n];
    let mut constant = 0.0;
    force[node] = -side;
    if node > 0 {
        let (before, offset) = elastic_torque(chain, mode, node - 1);
        row.iter_mut().zip(before).for_each(|(r, b)| *r -= side * b);
        constant -= side * offset;
    }
    if node < chain.shafts.len() {
        let (behind, offset) = elastic_torque(chain, mode, node);
        let gear = &chain.nodes[node];
        let driving = side * f64::from(mode.flow[node]) > 0.0;
        let factor = if driving { 1.0 / gear.efficiency } else { gear.back_efficiency };
        row.iter_mut().zip(behind).for_each(|(r, b)| *r += side * factor * b);
        constant += side * factor * offset;
    }
    (row, force, constant)
}
