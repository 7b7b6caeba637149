//! An unbalanced mass on a turning coordinate whose bearing moves along a way: the exciter of a vibrating machine.
//!
//! With the turning coordinate at `phi`, the mass stands at `x + r cos phi` along the way. Its own mass belongs to the
//! way's and `m r^2` to the inertia of what turns, so that the moment `S = m r` alone couples them. By Lagrange's
//! equations, gravity `g` pulling against the way:
//!
//! `M x'' - S (phi'' sin phi + phi'^2 cos phi) = forces`, `J phi'' - S sin phi (x'' + g) = torques`
//!
//! Two equal masses that turn against each other, as those of a linear exciter do, are one with the sum of their
//! moments; what they do across the way cancels. The solver integrates the momenta `M x' - S phi' sin phi` and
//! `J phi' - S x' sin phi`, whose rates hold no acceleration.

use nalgebra::{DMatrix, DVector, Dyn, LU};

use super::super::error::{PlantError, finite, in_range};
use super::super::event::Place;
use super::series::{Series, Turn, ZERO, product};
use super::stretch::Sized;
use super::{Coordinate, Train};

/// The coupling of a turning coordinate with a way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unbalance {
    /// The coordinate that turns.
    pub turning: usize,
    /// The coordinate that its bearing moves along.
    pub way: usize,
    /// `S`, mass times radius, kg m.
    pub moment: f64,
    /// Gravity against the way, m/s2.
    pub gravity: f64,
}

impl Unbalance {
    pub(super) fn validate(&self, train: &Train) -> Result<(), PlantError> {
        let n = train.coordinates.len();
        for at in [self.turning, self.way] {
            if at >= n {
                return Err(PlantError::Count { name: "coordinate of an unbalance", found: at, expected: n });
            }
        }
        if self.turning == self.way {
            return Err(PlantError::Count { name: "coordinates of an unbalance", found: 1, expected: 2 });
        }
        let place = Place::Node(self.turning);
        finite("gravity of an unbalance", place, self.gravity)?;
        let shared =
            |at: usize| train.unbalances.iter().filter(|other| [other.turning, other.way].contains(&at)).count() as f64;
        // with every coupling of a coordinate below its share, the inertias together stay positive
        let product = train.coordinates[self.turning].inertia * train.coordinates[self.way].inertia;
        let most = (product / (shared(self.turning) * shared(self.way))).sqrt();
        in_range(
            "moment of an unbalance",
            place,
            self.moment,
            self.moment.abs() < most,
            "less than its inertias carry",
        )?;
        let lossy = train.links.iter().filter(|link| link.efficiency < 1.0).map(|link| link.terms[0].0);
        let rubbing = train.frictions.iter().flat_map(|friction| friction.terms.iter().map(|term| term.0));
        let cranked = (0..n).filter(|&at| train.coordinates[at].crank.is_some());
        match lossy.chain(rubbing).chain(cranked).find(|&at| at == self.turning || at == self.way) {
            Some(at) => Err(PlantError::Parameter {
                name: "unbalance with dry friction, a lossy gear or a crank",
                place: Place::Node(at),
                value: self.moment,
                expected: "those on another coordinate, behind a shaft",
            }),
            None => Ok(()),
        }
    }

    /// Torque of gravity on what turns, at its angle, N m.
    pub(super) fn weight(&self, angle: f64) -> f64 {
        self.moment * self.gravity * angle.sin()
    }
}

/// The share of the square of the fastest rate that the couplings add: the least of all inertias together over that
/// without them.
pub(super) fn least(train: &Train) -> f64 {
    let coupled = |unbalance: &Unbalance| {
        let product = train.coordinates[unbalance.turning].inertia * train.coordinates[unbalance.way].inertia;
        unbalance.moment.abs() / product.sqrt()
    };
    1.0 - train.unbalances.iter().map(coupled).sum::<f64>()
}

/// The series of all unbalances of a train over a stretch.
pub(super) struct Work {
    turns: Vec<Turn>,
    /// Of every unbalance, the product of the two speeds.
    both: Vec<Series>,
    /// Of every coordinate.
    momentum: Vec<Sized>,
    inertias: LU<f64, Dyn, Dyn>,
}

impl Work {
    /// Nothing for a train without unbalances.
    pub fn of(train: &Train, angle: &[Sized], speed: &[Sized]) -> Option<Self> {
        if train.unbalances.is_empty() {
            return None;
        }
        let mut turns = Vec::with_capacity(train.unbalances.len());
        let inertia = |coordinate: &Coordinate| coordinate.inertia;
        let mut inertias = DMatrix::from_diagonal(&DVector::from_iterator(
            train.coordinates.len(),
            train.coordinates.iter().map(inertia),
        ));
        for unbalance in &train.unbalances {
            let mut turn = Turn::new(1.0);
            turn.extend(&angle[unbalance.turning].value, 0);
            let coupling = unbalance.moment * turn.sine[0];
            inertias[(unbalance.turning, unbalance.way)] -= coupling;
            inertias[(unbalance.way, unbalance.turning)] -= coupling;
            turns.push(turn);
        }
        let start = &inertias * DVector::from_iterator(speed.len(), speed.iter().map(|s| s.value[0]));
        let both = vec![ZERO; turns.len()];
        Some(Self { turns, both, momentum: start.iter().map(|&p| Sized::new(p)).collect(), inertias: inertias.lu() })
    }

    /// Adds what acts on the momenta, coefficient `k`.
    pub fn push(&mut self, train: &Train, speed: &[Sized], k: usize, net: &mut [f64], size: &mut [f64]) {
        for ((unbalance, turn), both) in train.unbalances.iter().zip(&self.turns).zip(&mut self.both) {
            let (way, turning) = (&speed[unbalance.way].value, &speed[unbalance.turning].value);
            both[k] = product(way, turning, k);
            let torque = unbalance.moment * (unbalance.gravity * turn.sine[k] - product(both, &turn.cosine, k));
            net[unbalance.turning] += torque;
            size[unbalance.turning] += torque.abs();
        }
    }

    /// Fills in coefficient `k + 1` of every speed from what acts, `step` of it.
    pub fn extend(&mut self, train: &Train, k: usize, step: f64, net: &[f64], size: &[f64], state: [&mut [Sized]; 2]) {
        let [angle, speed] = state;
        let mut right = DVector::zeros(net.len());
        for (j, momentum) in self.momentum.iter_mut().enumerate() {
            momentum.put(k + 1, step * net[j], step * size[j]);
            right[j] = momentum.value[k + 1];
        }
        for (unbalance, turn) in train.unbalances.iter().zip(&mut self.turns) {
            turn.extend(&angle[unbalance.turning].value, k + 1);
            for (to, from) in [(unbalance.way, unbalance.turning), (unbalance.turning, unbalance.way)] {
                let known: f64 = (1..=k + 1).map(|i| turn.sine[i] * speed[from].value[k + 1 - i]).sum();
                right[to] += unbalance.moment * known;
            }
        }
        // positive definite by the check of the moments
        if self.inertias.solve_mut(&mut right) {
            for (j, coordinate) in train.coordinates.iter().enumerate() {
                let least = self.momentum[j].size[k + 1] / coordinate.inertia;
                speed[j].put(k + 1, right[j], right[j].abs().max(least));
            }
        }
    }
}
