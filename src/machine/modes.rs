//! Natural frequencies and mode shapes of a chain, with the motor free and with the motor locked.

use super::chain::{CAPACITY, Chain};
use crate::math::sqrt;

pub(super) const SHAFTS: usize = CAPACITY - 1;

/// One column for each shaft, one row for each mass.
pub(super) type Columns = [[f64; CAPACITY]; SHAFTS];

/// A natural vibration of the free chain.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Mode {
    /// Natural frequency (rad/s), undamped.
    pub frequency: f64,
    /// Mass-normalised shape, the motor first (1/sqrt(kg m2)); zero beyond the chain's masses.
    pub shape: [f64; CAPACITY],
    /// Square of the shape at the motor (1/(kg m2)): modal gain from the motor's torque to its angle.
    pub residue: f64,
    /// Modal damping (1/s): twice the decay rate of the vibration while it is small against the frequency.
    pub damping: f64,
}

/// The natural vibrations of a chain or train in rising order, without the rigid turning at zero frequency.
///
/// B is the incidence matrix: a shaft's twist from the angles. The frequencies are the singular values of `sqrt(k) B /
/// sqrt(J)`. The left singular vectors of its transpose over `sqrt(J)` are the mass-normalised mode shapes. One-sided
/// Jacobi rotations find them without ever forming `inv(J) K`, which loses a third of the lowest frequency at stiffness
/// ratios of 1e15 [Demmel and Veselić 1992, SIAM J. Matrix Anal. Appl. 13(4)].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[doc(alias("torsional vibration", "natural frequency", "modal analysis"))]
pub struct Modes {
    mode: [Mode; SHAFTS],
    antiresonance: [f64; SHAFTS],
    count: usize,
}

impl Modes {
    /// The vibrations, one for each mass but the motor, lowest first.
    #[must_use]
    pub const fn resonances(&self) -> &[Mode] {
        self.mode.split_at(self.count).0
    }

    /// Modes without damping from the transposes of the scaled stiffness roots of the free machine and of the machine
    /// with its motor locked.
    pub(super) const fn of(inertia: &[f64; CAPACITY], count: usize, free: Columns, held: Columns) -> Self {
        let (free, held) = (singular(free, count), singular(held, count));
        let mut modes = Self {
            mode: [Mode { frequency: 0.0, shape: [0.0; CAPACITY], residue: 0.0, damping: 0.0 }; SHAFTS],
            antiresonance: held.0,
            count,
        };
        each!(i, 0..count, {
            let mode = &mut modes.mode[i];
            mode.frequency = free.0[i];
            each!(j, 0.., j <= count, {
                mode.shape[j] = free.1[i][j] / (mode.frequency * sqrt(inertia[j]));
            });
            mode.residue = mode.shape[0] * mode.shape[0];
        });
        modes
    }

    pub(super) const fn mode_mut(&mut self, index: usize) -> &mut Mode {
        &mut self.mode[index]
    }

    /// Natural frequencies with the motor locked (rad/s), one for each mass but the motor, lowest first.
    #[must_use]
    pub const fn antiresonances(&self) -> &[f64] {
        self.antiresonance.split_at(self.count).0
    }
}

impl Chain {
    /// Natural frequencies and shapes of the free chain, and its antiresonances with the motor locked.
    ///
    /// Gaps count as closed. Relative error of every frequency below 1e-14 for stiffness and inertia ratios up to 1e15.
    ///
    /// # Panics
    /// At compile time in a constant, with the sentence of the chain's [`error`](Self::error).
    #[must_use]
    pub const fn modes(&self) -> Modes {
        if let Some(error) = self.error {
            error.stop()
        }
        let shafts = self.count - 1;
        let mut stiffness = [0.0; SHAFTS];
        each!(j, 0..shafts, {
            stiffness[j] = self.shaft[j].stiffness;
        });
        let free = scaled_incidence(&self.inertia, &stiffness, shafts, false);
        let held = scaled_incidence(&self.inertia, &stiffness, shafts, true);
        let mut modes = Modes::of(&self.inertia, shafts, free, held);
        each!(i, 0..shafts, {
            let mode = modes.mode_mut(i);
            each!(j, 0..shafts, {
                let twist = mode.shape[j] - mode.shape[j + 1];
                mode.damping += self.shaft[j].damping * twist * twist;
            });
        });
        modes
    }
}

/// First resonance and first antiresonance (rad/s) of a chain with `shafts` shafts.
pub(super) const fn lowest(inertia: &[f64; CAPACITY], stiffness: &[f64; SHAFTS], shafts: usize) -> (f64, f64) {
    let free = singular(scaled_incidence(inertia, stiffness, shafts, false), shafts);
    let held = singular(scaled_incidence(inertia, stiffness, shafts, true), shafts);
    (free.0[0], held.0[0])
}

/// The transpose of `sqrt(k) B / sqrt(J)`, by columns; without the motor's row where it is locked.
const fn scaled_incidence(inertia: &[f64; CAPACITY], stiffness: &[f64; SHAFTS], shafts: usize, held: bool) -> Columns {
    let mut columns = [[0.0; CAPACITY]; SHAFTS];
    each!(j, 0..shafts, {
        if !(held && j == 0) {
            columns[j][j] = sqrt(stiffness[j] / inertia[j]);
        }
        columns[j][j + 1] = -sqrt(stiffness[j] / inertia[j + 1]);
    });
    columns
}

const fn dot(a: &[f64; CAPACITY], b: &[f64; CAPACITY], rows: usize) -> f64 {
    let mut sum = 0.0;
    each!(r, 0..rows, {
        sum += a[r] * b[r];
    });
    sum
}

/// Singular values in rising order, and the columns turned orthogonal: each a singular vector times its value.
const fn singular(mut columns: Columns, shafts: usize) -> ([f64; SHAFTS], Columns) {
    let rows = shafts + 1;
    let mut sweep = 0;
    let mut turned = true;
    while turned && sweep < 60 {
        turned = false;
        each!(p, 0.., p + 1 < shafts, {
            each!(q, (p + 1)..shafts, {
                if rotate(&mut columns, p, q, rows) {
                    turned = true;
                }
            });
        });
        sweep += 1;
    }
    let mut values = [0.0; SHAFTS];
    each!(i, 0..shafts, {
        values[i] = sqrt(dot(&columns[i], &columns[i], rows));
        // Insert in order.
        let mut j = i;
        while j > 0 && values[j - 1] > values[j] {
            values.swap(j - 1, j);
            columns.swap(j - 1, j);
            j -= 1;
        }
    });
    (values, columns)
}

/// Turns columns p and q orthogonal, the larger one first; false where they already are. One that changes places counts
/// as turned: it has not met all the others in this sweep.
const fn rotate(columns: &mut Columns, p: usize, q: usize, rows: usize) -> bool {
    let mut alpha = dot(&columns[p], &columns[p], rows);
    let mut beta = dot(&columns[q], &columns[q], rows);
    let swapped = alpha < beta;
    if swapped {
        columns.swap(p, q);
        (alpha, beta) = (beta, alpha);
    }
    let gamma = dot(&columns[p], &columns[q], rows);
    if gamma == 0.0 || gamma.abs() <= 0.5 * f64::EPSILON * sqrt(alpha) * sqrt(beta) {
        return swapped;
    }
    let zeta = (beta - alpha) / (2.0 * gamma);
    let tangent = if zeta.abs() > 1e150 {
        0.5 / zeta
    } else {
        let size = 1.0 / (zeta.abs() + sqrt(1.0 + zeta * zeta));
        if zeta < 0.0 { -size } else { size }
    };
    let cosine = 1.0 / sqrt(1.0 + tangent * tangent);
    let sine = cosine * tangent;
    each!(r, 0..rows, {
        let (a, b) = (columns[p][r], columns[q][r]);
        columns[p][r] = cosine * a - sine * b;
        columns[q][r] = sine * a + cosine * b;
    });
    true
}
