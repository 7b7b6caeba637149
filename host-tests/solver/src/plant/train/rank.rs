//! Rank of the links' terms, and the motions that strain none of them.

/// Share of a row's largest term below which a remainder is rounding.
const ROUNDING: f64 = 1e-9;

/// The links' terms, reduced by Gauss-Jordan elimination with full pivoting.
pub(super) struct Elimination {
    rows: Vec<Vec<f64>>,
    /// The coordinate that each row is solved for.
    pivots: Vec<usize>,
    coordinates: usize,
}

impl Elimination {
    /// Of links with these terms between so many coordinates.
    pub fn of<'a>(links: impl Iterator<Item = &'a [(usize, f64)]>, coordinates: usize) -> Self {
        let row = |terms: &[(usize, f64)]| {
            let largest = terms.iter().fold(0.0_f64, |most, term| most.max(term.1.abs()));
            let mut row = vec![0.0; coordinates];
            for &(at, share) in terms {
                row[at] = share / largest;
            }
            row
        };
        let mut rest: Vec<Vec<f64>> = links.map(row).collect();
        let mut found = Elimination { rows: Vec::new(), pivots: Vec::new(), coordinates };
        while let Some((at, pivot)) = found.pivot(&rest) {
            let mut row = rest.swap_remove(at);
            let size = row[pivot];
            row.iter_mut().for_each(|x| *x /= size);
            for other in found.rows.iter_mut().chain(&mut rest) {
                let share = other[pivot];
                if share != 0.0 {
                    other.iter_mut().zip(&row).for_each(|(x, y)| *x -= share * y);
                    other[pivot] = 0.0;
                }
            }
            found.rows.push(row);
            found.pivots.push(pivot);
        }
        found
    }

    /// The largest entry that is left.
    fn pivot(&self, rest: &[Vec<f64>]) -> Option<(usize, usize)> {
        let entries = rest.iter().enumerate().flat_map(|(i, row)| row.iter().enumerate().map(move |(j, x)| (i, j, x)));
        let largest = entries.max_by(|a, b| a.2.abs().total_cmp(&b.2.abs()))?;
        (largest.2.abs() > ROUNDING).then_some((largest.0, largest.1))
    }

    /// Links that are independent.
    pub fn rank(&self) -> usize {
        self.pivots.len()
    }

    /// The motions that strain no link, each coordinate times its root of the inertia; of length one and orthogonal.
    pub fn free_motions(&self, root: &[f64]) -> Vec<Vec<f64>> {
        let mut motions: Vec<Vec<f64>> = Vec::new();
        for free in (0..self.coordinates).filter(|j| !self.pivots.contains(j)) {
            let mut motion = vec![0.0; self.coordinates];
            motion[free] = root[free];
            for (row, &pivot) in self.rows.iter().zip(&self.pivots) {
                motion[pivot] = -row[free] * root[pivot];
            }
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
