//! The running train: state, mode, and its way through time.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, SymmetricEigen};

use super::leap::Leap;
use super::reading::Watch;
use super::stretch::{Stretch, TRAILING};
use super::{Source, Train, Variation, unbalance};
use crate::plant::event::Event;

/// Product of the fastest rate and a stretch: `1.5^24/24!` = 3e-20 is left out.
const REACH: f64 = 1.5;
/// Time within which an event is located unless told otherwise: at most this, s, and this share of the fastest rate.
const EVENT_TOLERANCE: (f64, f64) = (1e-14, 1e-13);

/// The continuous state.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct State {
    pub elongation: Vec<f64>,
    pub speed: Vec<f64>,
    pub angle: Vec<f64>,
}

/// Which smooth stretch is running.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Mode {
    /// Of each link: -1, 0, +1, or [`TRAILING`].
    pub contact: Vec<i8>,
    /// Of each friction: the direction it slides in, 0 while it sticks.
    pub slip: Vec<i8>,
    /// Of each link: the sign of its torque on its first coordinate, kept only where a lossy gear needs it.
    pub flow: Vec<i8>,
    /// Arcs as coordinate and source, and how many of their ends have been passed; odd on the arc.
    pub arcs: Vec<(usize, usize, i64)>,
    /// Links whose teeth follow an angle, and the edge ahead of each.
    pub teeth: Vec<(usize, i64)>,
    /// The frictions that stick, and what turns the accelerations they must stop into their forces.
    pub stuck: Vec<usize>,
    pub holding: DMatrix<f64>,
}

impl Mode {
    /// Whether the link carries force.
    pub fn carries(&self, train: &Train, link: usize) -> bool {
        train.links[link].is_linear() || self.contact[link].abs() == 1
    }

    /// What the first coordinate of a link feels, as a multiple of its force `[Wang 1989 §1-3]`.
    pub fn loss(&self, train: &Train, link: usize) -> f64 {
        let efficiency = train.links[link].efficiency;
        if efficiency == 1.0 {
            return 1.0;
        }
        let gear = train.frictions.iter().position(|friction| friction.losses.contains(&link));
        match gear.map_or(0, |s| self.slip[s]) * self.flow[link] {
            1 => 1.0 / efficiency,
            -1 => efficiency,
            _ => 1.0,
        }
    }

    pub fn on_arc(&self, coordinate: usize, source: usize) -> bool {
        self.arcs.iter().any(|&(j, s, passed)| j == coordinate && s == source && passed.rem_euclid(2) == 1)
    }

    /// The tooth edge ahead of a link.
    pub fn edge(&self, link: usize) -> i64 {
        self.teeth.iter().find(|tooth| tooth.0 == link).map_or(0, |tooth| tooth.1)
    }

    /// Gathers what sticks.
    pub fn gather(&mut self, train: &Train) {
        self.stuck = (0..train.frictions.len()).filter(|&s| self.slip[s] == 0).collect();
        if self.stuck.is_empty() {
            self.holding = DMatrix::zeros(0, 0);
            return;
        }
        let share = |s: usize, at: usize| {
            let terms = &train.frictions[s].terms;
            terms.iter().find(|term| term.0 == at).map_or(0.0, |term| term.1)
        };
        let count = self.stuck.len();
        let gram = DMatrix::from_fn(count, count, |a, b| {
            let terms = &train.frictions[self.stuck[a]].terms;
            terms.iter().map(|&(at, c)| c * share(self.stuck[b], at) / train.coordinates[at].inertia).sum::<f64>()
        });
        let size = gram.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        // where frictions hold each other the least forces will do
        self.holding = gram.pseudo_inverse(1e-12 * size).unwrap_or_else(|_| DMatrix::zeros(count, count));
    }
}

/// A train in motion. Built by [`Train::build`]; a clone runs on independently.
#[derive(Debug, Clone)]
pub struct Motion {
    pub(super) train: Train,
    pub(super) state: State,
    pub(super) mode: Mode,
    /// Time at the last end of a tick, s, with what its rounding has lost.
    clock: (f64, f64),
    /// Now, s.
    pub(super) now: f64,
    /// Torques held from outside.
    pub(super) held: Vec<f64>,
    pub(super) rate: f64,
    pub(super) settled: bool,
    pub(super) event_tolerance: f64,
    pub(super) events: Vec<Event>,
    pub(super) watches: Vec<Watch>,
    leap: Option<Leap>,
    refused: u64,
}

impl Motion {
    pub(super) fn new(train: Train) -> Self {
        let state = State {
            elongation: train.links.iter().map(|link| link.elongation).collect(),
            speed: train.coordinates.iter().map(|c| c.speed).collect(),
            angle: train.coordinates.iter().map(|c| c.angle).collect(),
        };
        let contact = train.links.iter().map(|link| {
            let reach = link.origin(1);
            let (ahead, back) = (link.elongation > reach, link.elongation < -reach && !link.rope);
            if link.is_linear() { 1 } else { i8::from(ahead) - i8::from(back) }
        });
        let mut arcs = Vec::new();
        for (j, coordinate) in train.coordinates.iter().enumerate() {
            for (s, source) in coordinate.sources.iter().enumerate() {
                if let Source::Arc { from, to, .. } = source {
                    let turn = (coordinate.angle / TAU).floor();
                    let within = coordinate.angle - turn * TAU;
                    let passed = i64::from(within >= *from) + i64::from(within >= *to);
                    arcs.push((j, s, 2 * turn as i64 + passed));
                }
            }
        }
        let mode = Mode {
            contact: contact.collect(),
            slip: vec![0; train.frictions.len()],
            flow: vec![1; train.links.len()],
            arcs,
            teeth: teeth_of(&train),
            stuck: Vec::new(),
            holding: DMatrix::zeros(0, 0),
        };
        let rate = fastest(&train);
        let leap = Leap::of(&train, rate);
        Self {
            rate,
            held: vec![0.0; train.coordinates.len()],
            train,
            state,
            mode,
            clock: (0.0, 0.0),
            now: 0.0,
            settled: false,
            event_tolerance: EVENT_TOLERANCE.0.min(EVENT_TOLERANCE.1 / rate),
            events: Vec::new(),
            watches: Vec::new(),
            leap,
            refused: 0,
        }
    }

    /// Holds this torque (N m or N) on a coordinate from now on, beside its sources. One that is not finite, or on a
    /// coordinate that is not there, changes nothing and counts as [`refused`](Self::refused).
    pub fn set_torque(&mut self, coordinate: usize, torque: f64) {
        match self.held.get_mut(coordinate) {
            Some(held) if torque.is_finite() => *held = torque,
            _ => self.refused += 1,
        }
    }

    /// How many calls were refused.
    #[must_use]
    pub fn refused(&self) -> u64 {
        self.refused
    }

    /// Locates events within this time, s, above zero; 1e-14 s or a 1e-13th of the fastest swing if not said.
    pub fn set_event_tolerance(&mut self, tolerance: f64) {
        if tolerance > 0.0 {
            self.event_tolerance = tolerance;
        } else {
            self.refused += 1;
        }
    }

    /// Runs on by `dt` seconds, above zero.
    pub fn advance(&mut self, dt: f64) {
        if !(dt.is_finite() && dt > 0.0) {
            self.refused += 1;
            return;
        }
        if !self.settled {
            self.settled = true;
            self.settle();
        }
        let (clock, lost) = self.clock;
        let step = dt + lost;
        let end = clock + step;
        let first = self.corner_after(self.now).filter(|&corner| corner < end);
        if first.is_some() || !self.leap(dt, end) {
            while let Some(corner) = self.corner_after(self.now).filter(|&corner| corner < end) {
                self.run_to(corner);
            }
            self.run_to(end);
        }
        // Neumaier's sum
        self.clock = (end, if clock >= step { (clock - end) + step } else { (step - end) + clock });
    }

    /// A whole tick of a linear train at once, where that is less work than its series.
    fn leap(&mut self, length: f64, end: f64) -> bool {
        if !self.watches.is_empty() || self.rate * length <= 2.0 * REACH {
            return false;
        }
        let Some(leap) = &mut self.leap else { return false };
        let state = &self.state;
        let x: Vec<f64> = state.elongation.iter().chain(&state.speed).chain(&state.angle).copied().collect();
        let Some(after) = leap.step(&self.train, &x, &self.held, self.now, length) else { return false };
        let (links, n) = (self.train.links.len(), self.train.coordinates.len());
        let part = |from: usize, count: usize| after[from..from + count].to_vec();
        self.state = State { elongation: part(0, links), speed: part(links, n), angle: part(links + n, n) };
        self.now = end;
        true
    }

    pub(super) fn corner_after(&self, time: f64) -> Option<f64> {
        let sources = self.train.coordinates.iter().flat_map(|c| &c.sources).filter_map(|s| s.corner_after(time));
        let meshes = self.train.links.iter().filter_map(|link| link.variation.as_ref()?.corner_after(time));
        sources.chain(meshes).reduce(f64::min)
    }

    /// The stretch from here on.
    pub(super) fn stretch(&self, length: f64) -> Stretch {
        Stretch::new(&self.train, &self.mode, &self.state, &self.held, self.now, length)
    }

    /// The longest stretch worth trying.
    pub(super) fn longest(&self, left: f64) -> f64 {
        if self.rate * left > REACH { REACH / self.rate } else { left }
    }

    pub(super) fn is_trailing(&self, link: usize) -> bool {
        self.mode.contact[link] == TRAILING
    }

    /// The angle, rad, of an end of an arc; even numbers begin it, odd ones end it.
    pub(super) fn arcs_end(&self, arc: usize, passed: i64) -> f64 {
        let (j, s, _) = self.mode.arcs[arc];
        let Source::Arc { from, to, .. } = &self.train.coordinates[j].sources[s] else { return f64::INFINITY };
        let within = if passed.rem_euclid(2) == 0 { from } else { to };
        passed.div_euclid(2) as f64 * TAU + within
    }
}

/// The edge ahead of every link whose teeth follow an angle, at the start.
pub(super) fn teeth_of(train: &Train) -> Vec<(usize, i64)> {
    let edge = |(l, link): (usize, &super::Link)| match &link.variation {
        Some(Variation::Teeth(teeth)) => Some((l, teeth.next_edge(train.coordinates[teeth.coordinate].angle))),
        _ => None,
    };
    train.links.iter().enumerate().filter_map(edge).collect()
}

/// Bound of the rates of a train, 1/s: the highest natural frequency with every link in contact at its stiffest, the
/// highest rate of damping, and how fast stiffnesses and torques swing.
fn fastest(train: &Train) -> f64 {
    let n = train.coordinates.len();
    let inertia: Vec<f64> = train.coordinates.iter().map(|c| c.inertia.sqrt()).collect();
    let (mut k, mut d) = (DMatrix::zeros(n, n), DMatrix::zeros(n, n));
    let mut swing = 0.0_f64;
    for link in &train.links {
        let loss = 1.0 / link.efficiency;
        for &(a, one) in &link.terms {
            for &(b, other) in &link.terms {
                let share = loss * one * other / (inertia[a] * inertia[b]);
                k[(a, b)] += share * link.stiffest();
                d[(a, b)] += share * link.damping;
            }
        }
        if let Some(variation) = &link.variation {
            swing = swing.max(variation.bounds(link.stiffness).1);
        }
    }
    for (j, coordinate) in train.coordinates.iter().enumerate() {
        let slope: f64 = coordinate
            .sources
            .iter()
            .map(|source| if let Source::Line { slope, .. } = source { slope.abs() } else { 0.0 })
            .sum();
        d[(j, j)] += (coordinate.viscous + slope) / coordinate.inertia;
        swing = coordinate.sources.iter().map(Source::rate).fold(swing, f64::max);
    }
    let most = |matrix: DMatrix<f64>| SymmetricEigen::new(matrix).eigenvalues.max().max(0.0);
    let least = unbalance::least(train).max(1e-3);
    (most(k) / least).sqrt() + most(d) / least + swing
}
