//! Natural frequencies and shapes of a train with every link in contact at its mean stiffness.

use nalgebra::{DMatrix, Schur};

use super::rank::Elimination;
use super::{Source, Train};
use crate::jacobi::{norm, orthogonal};
use crate::plant::error::PlantError;

/// Share of the fastest rate below which an eigenvalue of the damped equations is left out. Its rounding is some 1e-15
/// of that rate; what is a thousand times as large has three digits.
const ROUNDING: f64 = 1e-12;

/// Natural frequencies and shapes.
#[derive(Debug, Clone, PartialEq)]
pub struct TrainModes {
    /// rad/s, rising; exactly zero for a rigid motion.
    pub omega: Vec<f64>,
    /// Of each mode, the amplitude of every coordinate, scaled to `sum J q^2 = 1`.
    pub shapes: Vec<Vec<f64>>,
}

/// A damped vibration, or a decay without one: an eigenvalue `-decay + i omega`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Decay {
    /// 1/s; below zero where the motion grows.
    pub decay: f64,
    /// rad/s, zero or above.
    pub omega: f64,
}

impl Decay {
    /// Damping ratio: 1 of a decay without vibration.
    #[must_use]
    pub fn damping_ratio(&self) -> f64 {
        self.decay / self.decay.hypot(self.omega)
    }
}

impl TrainModes {
    /// Motions that strain no link.
    #[must_use]
    pub fn rigid_motions(&self) -> usize {
        self.omega.iter().take_while(|&&omega| omega == 0.0).count()
    }
}

impl Train {
    /// Undamped modes, without what unbalances couple. They are the singular values of the scaled incidence
    /// `sqrt(k) B / sqrt(J)` by one-sided Jacobi rotations: the stiffness is never formed, and each frequency keeps its
    /// digits whatever the ratios of inertia and stiffness. How many motions are rigid is the rank of `B` alone, which
    /// has no stiffness in it.
    ///
    /// # Errors
    /// [`PlantError`] as [`build`](Self::build).
    pub fn modes(&self) -> Result<TrainModes, PlantError> {
        self.validate()?;
        let n = self.coordinates.len();
        let root: Vec<f64> = self.inertias().iter().map(|inertia| inertia.sqrt()).collect();
        let springs: Vec<_> = self.links.iter().filter(|link| link.mean_stiffness() > 0.0).collect();
        let elimination = Elimination::of(springs.iter().map(|link| link.terms.as_slice()), n);
        let elastic = elimination.rank();
        let scaled = |link: &&super::Link| {
            let mut row = vec![0.0; n];
            for &(at, share) in &link.terms {
                row[at] = share * link.mean_stiffness().sqrt() / root[at];
            }
            row
        };
        let rows: Vec<Vec<f64>> = springs.iter().map(scaled).collect();
        // A column for each link where all are independent: it ends up as its frequency times its shape. Else a column
        // for each coordinate, with the row of the unit matrix below it that becomes the shape.
        let by_link = springs.len() == elastic;
        let (columns, length) = if by_link {
            (rows, n)
        } else {
            let column = |j: usize| {
                let unit = (0..n).map(move |i| f64::from(u8::from(i == j)));
                rows.iter().map(|row| row[j]).chain(unit).collect()
            };
            ((0..n).map(column).collect(), rows.len())
        };
        let mut modes: Vec<(f64, Vec<f64>)> = Vec::with_capacity(n);
        for column in orthogonal(columns, length).into_iter().take(elastic) {
            let omega = norm(&column[..length]);
            let shape: Vec<f64> =
                if by_link { column.iter().map(|x| x / omega).collect() } else { column[length..].to_vec() };
            modes.push((omega, shape));
        }
        modes.extend(elimination.free_motions(&root).into_iter().map(|shape| (0.0, shape)));
        modes.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (omega, scaled): (Vec<f64>, Vec<Vec<f64>>) = modes.into_iter().unzip();
        let shape = |shape: Vec<f64>| shape.iter().zip(&root).map(|(x, root)| x / root).collect();
        Ok(TrainModes { omega, shapes: scaled.into_iter().map(shape).collect() })
    }

    /// Damped vibrations and decays about standstill, the slowest first; one of each conjugate pair. None of what
    /// neither swings nor decays, nor of what is slower than 1e-12 of the fastest. Of the torques, lines alone
    /// count, with their slopes. They are the eigenvalues of the equations in `sqrt(J) v` and `sqrt(k) x`, whose
    /// rounding is that of the highest rate and not of its square.
    ///
    /// # Errors
    /// [`PlantError`] as [`build`](Self::build).
    pub fn decays(&self) -> Result<Vec<Decay>, PlantError> {
        self.validate()?;
        let n = self.coordinates.len();
        let root: Vec<f64> = self.inertias().iter().map(|inertia| inertia.sqrt()).collect();
        let size = n + self.links.len();
        let mut state = DMatrix::zeros(size, size);
        for (j, coordinate) in self.coordinates.iter().enumerate() {
            let slope = |source: &Source| if let Source::Line { slope, .. } = source { *slope } else { 0.0 };
            let fall = coordinate.viscous + coordinate.sources.iter().map(slope).sum::<f64>();
            state[(j, j)] = -fall / (root[j] * root[j]);
        }
        for (l, link) in self.links.iter().enumerate() {
            for &(at, share) in &link.terms {
                let strain = share * link.mean_stiffness().sqrt() / root[at];
                (state[(n + l, at)], state[(at, n + l)]) = (strain, -strain);
                for &(other, theirs) in &link.terms {
                    state[(at, other)] -= share * theirs * link.damping / (root[at] * root[other]);
                }
            }
        }
        // far more steps than the two or three of an eigenvalue
        let all = Schur::try_new(state, f64::EPSILON, 10_000).map(|schur| schur.complex_eigenvalues());
        let all = all.ok_or(PlantError::Count { name: "eigenvalues found", found: 0, expected: size })?;
        let fastest = all.iter().map(|value| value.norm()).fold(0.0, f64::max);
        let moves = all.iter().filter(|value| value.norm() > ROUNDING * fastest && value.im >= 0.0);
        let mut decays: Vec<Decay> = moves.map(|value| Decay { decay: -value.re, omega: value.im }).collect();
        decays.sort_by(|a, b| a.decay.hypot(a.omega).total_cmp(&b.decay.hypot(b.omega)));
        Ok(decays)
    }

    /// Inertia of every coordinate, kg m2 or kg, with what a crank or a law adds at its starting angle.
    #[must_use]
    pub fn inertias(&self) -> Vec<f64> {
        self.coordinates.iter().map(|c| c.inertia_at(c.angle)).collect()
    }
}
