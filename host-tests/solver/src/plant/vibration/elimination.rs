//! Elimination of the equations of coordinates and link forces, in an order that is chosen once.
//!
//! `[[D(s), B], [B^T, -1/k(s)]]`, with `D = s^2 J + s c` and the links' terms in B. Of a network without loops each
//! step leaves no entry that was not there, and every rounding is that of an inertia, a stiffness or a term: a pivot's
//! sign is right to the last digit of these [Demmel and Gragg 1993, Linear Algebra Appl. 185].

use std::collections::{BTreeMap, BTreeSet};

use super::Network;
use super::number::Number;

/// An entry beside the diagonal: a link's term, or one that the elimination makes or changes.
#[derive(Clone, Copy)]
enum Entry {
    Term(f64),
    Made(usize),
}

impl Entry {
    #[inline(always)]
    fn times<T: Number>(self, factors: &[T], by: T) -> T {
        match self {
            Self::Term(term) => by.scaled(term),
            Self::Made(place) => by.times(factors[place]),
        }
    }
}

/// A node that is eliminated: a coordinate, or behind all of them a link.
struct Step {
    node: usize,
    /// Nodes that are left beside it, and the entries between.
    beside: Vec<(usize, Entry)>,
    /// Of each pair of them, place of the entry between.
    changed: Vec<usize>,
}

/// The steps, and where the entries stand: first the diagonal, then those that are made.
pub(super) struct Elimination {
    steps: Vec<Step>,
    /// Terms that the elimination changes, and their places.
    terms: Vec<(usize, f64)>,
    entries: usize,
    nodes: usize,
}

impl Elimination {
    /// The node with the fewest neighbours first.
    pub fn of(network: &Network) -> Self {
        let coordinates = network.coordinates.len();
        let nodes = coordinates + network.links.len();
        let mut beside: Vec<BTreeMap<usize, Entry>> = vec![BTreeMap::new(); nodes];
        let (mut terms, mut entries) = (Vec::new(), nodes);
        for (node, link) in (coordinates..).zip(&network.links) {
            for &(at, share) in &link.terms {
                beside[node].insert(at, Entry::Term(share));
                beside[at].insert(node, Entry::Term(share));
            }
        }
        let mut waiting: BTreeSet<(usize, usize)> = (0..nodes).map(|node| (beside[node].len(), node)).collect();
        let mut steps = Vec::with_capacity(nodes);
        while let Some((_, node)) = waiting.pop_first() {
            let own: Vec<(usize, Entry)> = std::mem::take(&mut beside[node]).into_iter().collect();
            let mut changed = Vec::with_capacity(own.len() * (own.len() + 1) / 2);
            for &(a, _) in &own {
                waiting.remove(&(beside[a].len(), a));
                beside[a].remove(&node);
            }
            for (i, &(a, _)) in own.iter().enumerate() {
                changed.push(a);
                for &(b, _) in &own[i + 1..] {
                    let place = match beside[a].get(&b) {
                        Some(&Entry::Made(place)) => place,
                        other => {
                            if let Some(&Entry::Term(term)) = other {
                                terms.push((entries, term));
                            }
                            entries += 1;
                            entries - 1
                        }
                    };
                    beside[a].insert(b, Entry::Made(place));
                    beside[b].insert(a, Entry::Made(place));
                    changed.push(place);
                }
            }
            waiting.extend(own.iter().map(|&(a, _)| (beside[a].len(), a)));
            steps.push(Step { node, beside: own, changed });
        }
        Self { steps, terms, entries, nodes }
    }

    /// Turns the diagonal into the inverses of the pivots and the entries that are made; `pivot` is given each pivot
    /// and its inverse.
    pub fn run<T: Number>(&self, factors: &mut Vec<T>, mut pivot: impl FnMut(T, T)) {
        factors.resize(self.entries, T::ZERO);
        for &(place, term) in &self.terms {
            factors[place] = T::real(term);
        }
        for Step { node, beside, changed } in &self.steps {
            let value = factors[*node];
            let inverse = value.inverse();
            pivot(value, inverse);
            factors[*node] = inverse;
            let mut changed = changed.iter();
            for (i, &(_, left)) in beside.iter().enumerate() {
                let share = left.times(factors, inverse);
                for (&(_, right), &place) in beside[i..].iter().zip(&mut changed) {
                    factors[place] = factors[place].minus(right.times(factors, share));
                }
            }
        }
    }

    /// Solves for a right side, with the factors of [`run`](Self::run).
    pub fn solve<T: Number>(&self, factors: &[T], side: &mut [T]) {
        for Step { node, beside, .. } in &self.steps {
            let share = side[*node].times(factors[*node]);
            for &(other, entry) in beside {
                side[other] = side[other].minus(entry.times(factors, share));
            }
        }
        for Step { node, beside, .. } in self.steps.iter().rev() {
            let rest =
                beside.iter().fold(side[*node], |rest, &(other, entry)| rest.minus(entry.times(factors, side[other])));
            side[*node] = rest.times(factors[*node]);
        }
    }

    /// Coordinates and links.
    pub const fn nodes(&self) -> usize {
        self.nodes
    }
}
