//! Rank of the links' terms, and the motions that strain none of them.

use std::collections::{BTreeMap, BTreeSet};

/// Share of a row's largest term below which a remainder is rounding.
const ROUNDING: f64 = 1e-9;

/// Share of a row's largest entry that its pivot has at least.
const PIVOT: f64 = 0.1;

/// The links' terms, reduced by sparse elimination: the shortest row first, and of it the shortest column.
pub(in crate::plant) struct Elimination {
    /// Each without the coordinates that the rows before it are solved for, its own with the factor 1.
    rows: Vec<BTreeMap<usize, f64>>,
    /// The coordinate that each row is solved for.
    pivots: Vec<usize>,
    coordinates: usize,
}

impl Elimination {
    /// Of links with these terms between so many coordinates.
    pub fn of<'a>(links: impl Iterator<Item = &'a [(usize, f64)]>, coordinates: usize) -> Self {
        let row = |terms: &[(usize, f64)]| -> BTreeMap<usize, f64> {
            let largest = terms.iter().fold(0.0_f64, |most, term| most.max(term.1.abs()));
            terms.iter().map(|&(at, share)| (at, share / largest)).collect()
        };
        let mut rest: Vec<BTreeMap<usize, f64>> = links.map(row).collect();
        let mut columns = vec![BTreeSet::new(); coordinates];
        for (i, row) in rest.iter().enumerate() {
            row.keys().for_each(|&at| {
                columns[at].insert(i);
            });
        }
        let mut waiting: BTreeSet<(usize, usize)> = rest.iter().enumerate().map(|(i, row)| (row.len(), i)).collect();
        let mut found = Self { rows: Vec::new(), pivots: Vec::new(), coordinates };
        while let Some((_, i)) = waiting.pop_first() {
            let mut row = std::mem::take(&mut rest[i]);
            row.keys().for_each(|at| {
                columns[*at].remove(&i);
            });
            let largest = row.values().fold(0.0_f64, |most, x| most.max(x.abs()));
            let large = row.iter().filter(|(_, x)| x.abs() >= PIVOT * largest);
            let Some((&pivot, &size)) = large.min_by_key(|(at, _)| columns[**at].len()).filter(|_| largest > ROUNDING)
            else {
                continue;
            };
            row.values_mut().for_each(|x| *x /= size);
            for other in std::mem::take(&mut columns[pivot]) {
                let changed = &mut rest[other];
                waiting.remove(&(changed.len(), other));
                let share = changed.remove(&pivot).unwrap_or(0.0);
                for (&at, x) in row.iter().filter(|(at, _)| **at != pivot) {
                    let entry = changed.entry(at).or_insert(0.0);
                    let before = entry.abs().max((share * x).abs());
                    *entry -= share * x;
                    if entry.abs() <= f64::EPSILON * before {
                        changed.remove(&at);
                        columns[at].remove(&other);
                    } else {
                        columns[at].insert(other);
                    }
                }
                waiting.insert((changed.len(), other));
            }
            found.rows.push(row);
            found.pivots.push(pivot);
        }
        found
    }

    /// Links that are independent.
    pub fn rank(&self) -> usize {
        self.pivots.len()
    }

    /// The motions that strain no link, each coordinate times its root of the inertia; of length one and orthogonal.
    pub fn free_motions(&self, root: &[f64]) -> Vec<Vec<f64>> {
        let mut motions: Vec<Vec<f64>> = Vec::new();
        let solved: BTreeSet<usize> = self.pivots.iter().copied().collect();
        for free in (0..self.coordinates).filter(|j| !solved.contains(j)) {
            let mut motion = vec![0.0; self.coordinates];
            motion[free] = 1.0;
            for (row, &pivot) in self.rows.iter().zip(&self.pivots).rev() {
                motion[pivot] = -row.iter().filter(|(at, _)| **at != pivot).map(|(&at, x)| x * motion[at]).sum::<f64>();
            }
            motion.iter_mut().zip(root).for_each(|(x, root)| *x *= root);
            // twice: once leaves what cancellation left
            for _ in 0..2 {
                for other in &motions {
                    let along: f64 = motion.iter().zip(other).map(|(x, y)| x * y).sum();
                    motion.iter_mut().zip(other).for_each(|(x, y)| *x -= along * y);
                }
            }
            let length = motion.iter().map(|x| x * x).sum::<f64>().sqrt();
            motion.iter_mut().for_each(|x| *x /= length);
            motions.push(motion);
        }
        motions
    }
}
