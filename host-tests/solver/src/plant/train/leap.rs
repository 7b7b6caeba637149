//! A whole tick at once by the matrix exponential, while the equations of a mode are linear and no guard falls.
//!
//! Every mode, which is what contacts, frictions and flows of power are, has matrices and guards of its own, which are
//! kept. They are made of the mode's own equations, one state at a time, once the mode has lasted so many ticks that
//! they pay.

use nalgebra::{DMatrix, SymmetricEigen};

use super::motion::Motion;
use super::series::ZERO;
use super::state::{Mode, State};
use super::stretch::Stretch;
use super::{Source, Train};
use crate::plant::propagator::{Propagator, add_product, product};

/// Steps kept of each mode; a run of one tick length needs one.
const STEPS_KEPT: usize = 4;
/// Modes kept.
const MODES_KEPT: usize = 64;
/// States squared over this: ticks in a mode after which its matrices cost less than the series of as many ticks.
const PATIENCE: usize = 64;

/// The modes that were met.
#[derive(Debug, Clone, Default)]
pub(super) struct Leap {
    known: Vec<Known>,
    /// That of now, until something else than a leap may have changed it.
    current: Option<usize>,
    /// Elongations, speeds, torques on the coordinates, and 1: at the start and at the end.
    now: Vec<f64>,
    last: Vec<f64>,
    /// Their rates.
    rate: Vec<f64>,
    /// Of the guards, at the start and at the end.
    values: [Vec<f64>; 2],
    /// Elongations, speeds, angles after the step.
    pub after: Vec<f64>,
}

/// A mode, and its matrices once it has lasted.
#[derive(Debug, Clone)]
struct Known {
    contact: Vec<i8>,
    slip: Vec<i8>,
    flow: Vec<i8>,
    ticks: usize,
    length: f64,
    regime: Option<Regime>,
}

/// `x' = A x + B f` of elongations, speeds and angles; `f` the torques on the coordinates, and 1.
#[derive(Debug, Clone)]
struct Regime {
    a: DMatrix<f64>,
    b: DMatrix<f64>,
    /// Rates of elongations and speeds, and what must not fall below zero, of elongations, speeds and torques.
    rates: DMatrix<f64>,
    guards: DMatrix<f64>,
    /// Of each guard, a bound of the second derivative per unit of the energy norm of `x'`; infinite where none is.
    bends: Vec<f64>,
    /// Square root of twice the energy per unit of state; zero where a state stores none.
    energy: Vec<f64>,
    /// Bound of the growth of the energy norm, 1/s: zero unless a loss, a motor or a surface feeds the motion.
    growth: f64,
    /// Bound of every rate, 1/s.
    rate: f64,
    balance: Vec<f64>,
    steps: Vec<Propagator>,
}

impl Leap {
    /// None for a train with torques, stiffnesses or inertias that are not linear in state and time within a mode.
    pub fn of(train: &Train) -> Option<Box<Self>> {
        let linear = |source: &Source| match source {
            Source::Constant(_) | Source::Program(_) | Source::Line { .. } => true,
            Source::Starting { power, .. } => *power == 1,
            _ => false,
        };
        let coordinates =
            train.coordinates.iter().all(|c| !c.is_cranked() && c.gear.is_none() && c.sources.iter().all(linear));
        let links = train.links.iter().all(|link| link.variation.is_none());
        (coordinates && links && train.unbalances.is_empty()).then(Box::default)
    }

    /// Something else than a leap may have changed the mode.
    pub fn look_again(&mut self) {
        self.current = None;
    }

    /// Goes over a tick of this length with no corner of a torque on the way: the state after it stands in `after`.
    /// Not in a mode that is new, and not where a guard may fall.
    pub fn step(&mut self, motion: &Motion, length: f64) -> bool {
        let (train, state) = (&motion.train, &motion.state);
        let moving = train.links.len() + train.coordinates.len();
        let at = self.current.unwrap_or_else(|| self.find(&motion.mode));
        self.current = Some(at);
        let known = &mut self.known[at];
        if std::mem::replace(&mut known.length, length) != length {
            return false;
        }
        known.ticks += 1;
        if known.ticks <= moving * moving / PATIENCE {
            return false;
        }
        let regime = known.regime.get_or_insert_with(|| Regime::of(motion));
        self.now.clear();
        self.now.extend(state.elongation.iter().chain(&state.speed).chain(&motion.held).chain(&[1.0]));
        self.rate.clear();
        self.rate.resize(self.now.len(), 0.0);
        for (j, coordinate) in train.coordinates.iter().enumerate() {
            for source in &coordinate.sources {
                let mut series = ZERO;
                source.add_over(&mut series, motion.now, length, false);
                if let Source::Line { stall, .. } = source {
                    series[0] += stall;
                }
                self.now[moving + j] += series[0];
                self.rate[moving + j] += series[1] / length;
            }
        }
        let rise = &self.rate[moving..];
        let ramped = rise.iter().any(|rise| *rise != 0.0);
        let step = regime.step_of(length);
        regime.steps[step].apply(&self.now, ramped.then_some(rise), &mut self.after);
        self.after[moving..].iter_mut().zip(&state.angle).for_each(|(after, before)| *after += before);
        if regime.bends.is_empty() {
            return true;
        }
        let (mut rising, mut growing) = (Vec::new(), 0.0);
        if ramped {
            product(&regime.rates, &self.rate, &mut rising);
            growing = regime.norm(&rising);
        }
        self.last.clear();
        let ends = self.now[moving..].iter().zip(rise).map(|(torque, rise)| torque + rise * length);
        self.last.extend(self.after[..moving].iter().copied().chain(ends));
        self.rate[..moving].fill(0.0);
        add_product(&regime.rates, &self.now, &mut self.rate[..moving]);
        let norm = (regime.norm(&self.rate) + length * growing) * (regime.growth * length).exp();
        let [before, after] = &mut self.values;
        product(&regime.guards, &self.now, before);
        product(&regime.guards, &self.last, after);
        // certainly above zero all through the tick
        (0..before.len()).all(|g| {
            let (before, after) = (before[g], after[g]);
            if !(before >= 0.0 && after > 0.0) {
                return false;
            }
            let bend = regime.bends[g] * norm + if ramped { regime.guard(g, &rising).abs() } else { 0.0 };
            before.min(after) > 0.125 * bend * length * length || regime.guard(g, &self.rate) > bend * length
        })
    }

    fn find(&mut self, mode: &Mode) -> usize {
        let is = |known: &Known| known.contact == mode.contact && known.slip == mode.slip && known.flow == mode.flow;
        self.known.iter().position(is).unwrap_or_else(|| {
            if self.known.len() == MODES_KEPT {
                self.known.clear();
            }
            let (contact, slip, flow) = (mode.contact.clone(), mode.slip.clone(), mode.flow.clone());
            self.known.push(Known { contact, slip, flow, ticks: 0, length: 0.0, regime: None });
            self.known.len() - 1
        })
    }
}

impl Regime {
    fn of(motion: &Motion) -> Self {
        let (links, n) = (motion.train.links.len(), motion.train.coordinates.len());
        let (moving, m) = (links + n, links + 2 * n);
        let mut probe = motion.probe();
        for coordinate in &mut probe.train.coordinates {
            coordinate.sources.retain(|source| matches!(source, Source::Line { .. }));
            for source in &mut coordinate.sources {
                if let Source::Line { stall, .. } = source {
                    *stall = 0.0;
                }
            }
        }
        let constant = looked_at(&mut probe, None);
        // without what is constant a small share of a state loses no digits
        for link in probe.train.links.iter_mut().filter(|link| link.gap > 0.0) {
            link.gap = f64::MIN_POSITIVE;
        }
        for friction in &mut probe.train.frictions {
            (friction.kinetic, friction.breakaway, friction.surface) = (0.0, 0.0, 0.0);
        }
        // a speed that the ground holds is zero: it neither changes nor moves anything
        let train = &motion.train;
        let at_rest =
            |s: &usize, at: usize| train.frictions[*s].terms == [(at, 1.0)] && train.frictions[*s].surface == 0.0;
        let held = |at: usize| motion.mode.stuck.iter().any(|s| at_rest(s, at));
        let mut columns: Vec<(Vec<f64>, Vec<f64>)> = (0..moving)
            .map(|column| match column.checked_sub(links) {
                Some(at) if held(at) => (vec![0.0; m], vec![0.0; constant.1.len()]),
                _ => looked_at(&mut probe, Some(column)),
            })
            .collect();
        for j in 0..n {
            probe.held[j] = 1.0;
            columns.push(looked_at(&mut probe, None));
            probe.held[j] = 0.0;
        }
        columns.push(constant);
        let a = DMatrix::from_fn(m, m, |row, column| if column < moving { columns[column].0[row] } else { 0.0 });
        let b = DMatrix::from_fn(m, n + 1, |row, column| columns[moving + column].0[row]);
        let rates = DMatrix::from_fn(moving, columns.len(), |row, column| columns[column].0[row]);
        let guards = DMatrix::from_fn(columns[0].1.len(), columns.len(), |row, column| columns[column].1[row]);
        let carried = |l: usize| if motion.mode.carries(train, l) { train.links[l].stiffness.sqrt() } else { 0.0 };
        let inertia = |j: usize| train.coordinates[j].inertia.sqrt();
        let energy: Vec<f64> = (0..links).map(carried).chain((0..n).map(inertia)).collect();
        let (growth, rate) = energy_bounds(&a, &energy);
        let stretched = |l: usize| if train.links[l].stiffness > 0.0 { train.links[l].stiffness.sqrt() } else { 1.0 };
        let turned = |j: usize| inertia(j) * rate.max(1.0);
        let balance = (0..links).map(stretched).chain((0..n).map(inertia)).chain((0..n).map(turned)).collect();
        let bend = |guard: usize| {
            let share = |column: usize| {
                let slope: f64 = (0..moving).map(|row| guards[(guard, row)] * a[(row, column)]).sum();
                match (slope == 0.0, energy[column] == 0.0) {
                    (true, _) => 0.0,
                    (false, true) => f64::INFINITY,
                    (false, false) => (slope / energy[column]).powi(2),
                }
            };
            (0..moving).map(share).sum::<f64>().sqrt()
        };
        let bends = (0..guards.nrows()).map(bend).collect();
        Self { a, b, rates, guards, bends, energy, growth, rate, balance, steps: Vec::new() }
    }

    /// A guard of a vector, which may be shorter.
    fn guard(&self, guard: usize, v: &[f64]) -> f64 {
        v.iter().enumerate().map(|(column, v)| self.guards[(guard, column)] * v).sum()
    }

    /// Energy norm of the rates of elongations and speeds.
    fn norm(&self, rate: &[f64]) -> f64 {
        rate.iter().zip(&self.energy).map(|(v, e)| (v * e) * (v * e)).sum::<f64>().sqrt()
    }

    /// The exact step of this length.
    fn step_of(&mut self, length: f64) -> usize {
        self.steps.iter().position(|kept| kept.step == length).unwrap_or_else(|| {
            if self.steps.len() == STEPS_KEPT {
                self.steps.remove(0);
            }
            self.steps.push(Propagator::new(&self.a, &self.b, self.rates.nrows(), &self.balance, self.rate, length));
            self.steps.len() - 1
        })
    }
}

/// Rates of the states and guards, with everything zero but the torques held and one elongation or speed.
fn looked_at(probe: &mut Motion, one: Option<usize>) -> (Vec<f64>, Vec<f64>) {
    let (links, n) = (probe.train.links.len(), probe.train.coordinates.len());
    let mut state = State { elongation: vec![0.0; links], speed: vec![0.0; n], angle: vec![0.0; n] };
    match one {
        Some(column) if column < links => state.elongation[column] = 1.0,
        Some(column) => state.speed[column - links] = 1.0,
        None => {}
    }
    probe.state = state;
    let now = Stretch::now(&probe.train, &probe.mode, &probe.state, &probe.held, 0.0, 1.0);
    // what the gap that stands for none has left
    let kept = |value: f64| if value.abs() < 1e-280 { 0.0 } else { value };
    let moved = now.elongation.iter().chain(&now.speed).chain(&now.angle);
    let rates = moved.map(|series| kept(series.value[1])).collect();
    let mut guards = Vec::new();
    probe.guards(&now, |_, (series, _)| guards.push(kept(series[0])));
    (rates, guards)
}

/// Largest eigenvalue of the symmetric part, not below zero, and the spectral norm of `A` in energy coordinates.
fn energy_bounds(a: &DMatrix<f64>, energy: &[f64]) -> (f64, f64) {
    let kept: Vec<usize> = (0..energy.len()).filter(|&i| energy[i] > 0.0).collect();
    let scaled =
        DMatrix::from_fn(kept.len(), kept.len(), |r, c| a[(kept[r], kept[c])] * energy[kept[r]] / energy[kept[c]]);
    let symmetric = (&scaled + scaled.transpose()) * 0.5;
    let growth = SymmetricEigen::new(symmetric).eigenvalues.max().max(0.0);
    let norm = SymmetricEigen::new(scaled.transpose() * &scaled).eigenvalues.max().max(0.0).sqrt();
    // rounding of the eigenvalues must not undercut the bounds
    let slack = 1e-12 * norm;
    (growth + slack, norm + slack)
}
