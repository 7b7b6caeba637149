//! The motion of coordinates that unbalances couple: their series over a stretch, and what they add to the fastest
//! rate.

use nalgebra::{DMatrix, DVector, Dyn, LU};

use super::series::{Series, Turn, ZERO, product};
use super::sized::Sized;
use super::unbalance::Unbalance;
use super::{Coordinate, Train};

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
