//! Branched and closed drive trains: chains that stand on one another's masses, and shafts that close loops.

use super::chain::{CAPACITY, Chain, Shaft, in_a_row};
use super::error::not_negative;
use super::error::positive;
use super::modes::{Columns, Modes, SHAFTS};
use super::refer::{Flow, Side, refer_gap, refer_inertia, refer_stiffness};
use super::{Damping, Error, Ratio, Rigid, Stiffness};
use crate::math::sqrt;

/// The most shafts that a train can hold, those that close loops included.
pub const TRAIN_SHAFTS: usize = 2 * SHAFTS;

/// A shaft of a train and the masses that it joins.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Joint {
    /// Index of the mass nearer the motor.
    pub from: usize,
    /// Index of the other mass.
    pub to: usize,
    /// The shaft, referred to the motor.
    pub shaft: Shaft,
}

/// A train of masses and shafts with branches and loops, referred to the motor's shaft.
///
/// Losses are as in a [`Chain`]: each shaft has the efficiency of its gears, and a branch is reached through the shafts
/// of the tree between the motor and its mass. They count in the torque of the weights, and in inertias and stiffnesses
/// where the first chain begins with [`starting`](Chain::starting) or [`braking`](Chain::braking).
///
/// Everything is referred to the motor, the mass of index 0. Twists of the shafts of a tree are independent. A shaft
/// that closes a loop is twisted by the sum of those round the loop, with signs and no other factors. So the strain
/// energy is `|R delta|^2`, with R from the tree's shafts. Where there are loops, R is from a triangulation of all
/// shafts by Householder's reflections. Frequencies are the singular values of `R B / sqrt(J)`. `inv(J) K` is never
/// formed; without loops R is diagonal, and the accuracy is that of a chain [Demmel and Veselić 1992].
///
/// ```
/// use driveline::machine::{Chain, Damping, Inertia, Ratio, Stiffness, Train};
/// // one motor of 0.5 kg m2 turns two equal rotors through a shaft each
/// const HALF: Chain = Chain::motor(Inertia(0.25)).shaft(Stiffness(5.0e3), Damping(0.0)).rotor(Inertia(0.25));
/// const PAIR: Train = Train::of(HALF).branch(0, Ratio(1.0), HALF);
/// // in opposition, sqrt(k/J), which the motor does not feel; and both against the motor, sqrt(2) of that
/// let modes = PAIR.modes();
/// let [opposed, common] = [0, 1].map(|k| modes.resonances()[k].frequency);
/// assert!((opposed - 141.42).abs() < 0.01 && (common - 200.0).abs() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Train {
    pub(super) inertia: [f64; CAPACITY],
    count: usize,
    /// The shafts of the tree, each the only one towards the motor of the mass `to = index + 1`; the others follow.
    joint: [Joint; TRAIN_SHAFTS],
    /// Shafts that close loops.
    closing: usize,
    flow: Flow,
    /// Inertia of dampers' rings that slips in the main mode (kg m2).
    pub(super) slipping: f64,
    /// Damping of each mass by slipping rings (N m s/rad).
    pub(super) drag: [f64; CAPACITY],
    /// Weight torque without losses, hoisting and lowering (N m).
    gravity: f64,
    /// The first chain or shaft that was refused, and why.
    error: Option<Error>,
}

impl Train {
    /// A train of one chain.
    ///
    /// A train carries the first [`error`](Self::error) of its chains, or of what joins them, to its end, as a chain
    /// does.
    ///
    /// Refused: as [`Chain::check`].
    #[must_use]
    pub const fn of(chain: Chain) -> Self {
        let mut joint = [Joint { from: 0, to: 0, shaft: Shaft::NONE }; TRAIN_SHAFTS];
        each!(j, 0.., j + 1 < chain.count, {
            joint[j] = Joint { from: j, to: j + 1, shaft: chain.shaft[j] };
        });
        Self {
            inertia: chain.inertia,
            count: chain.count,
            joint,
            closing: 0,
            flow: chain.flow,
            slipping: 0.0,
            drag: [0.0; CAPACITY],
            gravity: chain.gravity,
            error: match chain.check() {
                Ok(()) => None,
                Err(error) => Some(error),
            },
        }
    }

    /// Leaves a branch or a shaft out.
    pub(super) const fn refuse(mut self, error: Error) -> Self {
        if self.error.is_none() {
            self.error = Some(error);
        }
        self
    }

    /// Why a chain or a shaft was refused, the first one that was.
    #[must_use]
    pub const fn error(&self) -> Option<Error> {
        self.error
    }

    /// A chain on a mass of the train: its first inertia is added to the mass of index `at`, which turns `ratio` times
    /// as fast (the motor's speed over that of the branch's first inertia). Its masses follow those that are there, in
    /// their order. Its weight counts as well. A gear of the branch is an element of it: `ratio` has no loss of its
    /// own.
    ///
    /// Refused: [`Error::BranchNode`], [`Error::GearRatio`], [`Error::TooManyMasses`], as [`Chain::check`].
    #[must_use]
    pub const fn branch(mut self, at: usize, ratio: Ratio, branch: Chain) -> Self {
        if at >= self.count || self.closing > 0 {
            return self.refuse(Error::BranchNode);
        }
        let square = ratio.0 * ratio.0;
        if !positive(ratio.0) || !positive(square) {
            return self.refuse(Error::GearRatio);
        }
        if let Err(error) = branch.check() {
            return self.refuse(error);
        }
        if self.count + branch.count - 1 > CAPACITY {
            return self.refuse(Error::TooManyMasses);
        }
        let [efficiency, back] = self.efficiencies(at);
        let (flow, loss) = (self.flow, if matches!(self.flow, Flow::Overhauling) { back } else { efficiency });
        self.inertia[at] += refer_inertia(branch.inertia[0], ratio.0, loss, Side::Load, flow);
        self.gravity += branch.gravity / ratio.0;
        let first = self.count;
        each!(j, 1..branch.count, {
            let own = branch.shaft[j - 1];
            let shaft = Shaft {
                stiffness: refer_stiffness(own.stiffness, ratio.0, loss, Side::Load, flow),
                damping: refer_stiffness(own.damping, ratio.0, loss, Side::Load, flow),
                gap: refer_gap(own.gap, ratio.0, Side::Load),
                ..own
            };
            self.inertia[self.count] = refer_inertia(branch.inertia[j], ratio.0, loss, Side::Load, flow);
            self.joint[self.count - 1] = Joint { from: if j == 1 { at } else { first + j - 2 }, to: self.count, shaft };
            self.count += 1;
        });
        self
    }

    /// A shaft between two masses that are there already: it closes a loop. Stiffness and damping on its own speed, the
    /// motor's over which is `ratio`. The ratios of a train that can turn agree round each loop, which is taken as
    /// given: ends of the shaft turn alike when nothing twists.
    ///
    /// Refused: [`Error::BranchNode`], [`Error::GearRatio`], [`Error::ShaftStiffness`], [`Error::ShaftDamping`],
    /// [`Error::TooManyShafts`].
    #[must_use]
    pub const fn close(mut self, from: usize, to: usize, ratio: Ratio, stiffness: Stiffness, damping: Damping) -> Self {
        if from >= self.count || to >= self.count || from == to {
            return self.refuse(Error::BranchNode);
        }
        if !positive(ratio.0) {
            return self.refuse(Error::GearRatio);
        }
        let square = ratio.0 * ratio.0;
        if !positive(stiffness.0 / square) {
            return self.refuse(Error::ShaftStiffness);
        }
        if !not_negative(damping.0 / square) {
            return self.refuse(Error::ShaftDamping);
        }
        let at = self.count - 1 + self.closing;
        if at >= TRAIN_SHAFTS {
            return self.refuse(Error::TooManyShafts);
        }
        let shaft = Shaft { stiffness: stiffness.0 / square, damping: damping.0 / square, ..Shaft::NONE };
        self.joint[at] = Joint { from, to, shaft };
        self.closing += 1;
        self
    }

    /// Inertias (kg m2), the motor first, then those of its chain, then those of the branches in their order.
    #[must_use]
    pub const fn masses(&self) -> &[f64] {
        self.inertia.split_at(self.count).0
    }

    /// The shafts: those of chain and branches, then those that close loops.
    #[must_use]
    pub const fn joints(&self) -> &[Joint] {
        self.joint.split_at(self.count - 1 + self.closing).0
    }

    /// Sum of the inertias (kg m2), with what slips of [dampers](Self::damper).
    #[must_use]
    pub const fn total_inertia(&self) -> f64 {
        let mut sum = self.slipping;
        each!(j, 0..self.count, {
            sum += self.inertia[j];
        });
        sum
    }

    /// Largest sum of gaps (rad) between the motor and an end of the train, loops left out.
    #[must_use]
    pub const fn total_gap(&self) -> f64 {
        let mut gap = [0.0; CAPACITY];
        let mut largest = 0.0;
        each!(j, 0.., j + 1 < self.count, {
            gap[j + 1] = gap[self.joint[j].from] + self.joint[j].shaft.gap;
            if gap[j + 1] > largest {
                largest = gap[j + 1];
            }
        });
        largest
    }

    /// Torque of the weights at the motor (N m), without losses.
    #[must_use]
    pub const fn gravity_torque(&self) -> f64 {
        self.gravity
    }

    /// Efficiency between the motor and a mass while the motor drives, by the shafts of the tree; 1 beyond the masses.
    #[must_use]
    pub const fn efficiency(&self, mass: usize) -> f64 {
        self.efficiencies(mass)[0]
    }

    /// [`efficiency`](Self::efficiency) while the load drives.
    #[must_use]
    pub const fn back_efficiency(&self, mass: usize) -> f64 {
        self.efficiencies(mass)[1]
    }

    /// Both.
    const fn efficiencies(&self, mass: usize) -> [f64; 2] {
        let mut both = [1.0; 2];
        let mut node = if mass < self.count { mass } else { 0 };
        while node != 0 {
            let Joint { from, shaft, .. } = self.joint[node - 1];
            both = in_a_row([shaft.efficiency, shaft.back_efficiency], both);
            node = from;
        }
        both
    }

    /// The whole train as one mass.
    ///
    /// # Panics
    /// At compile time in a constant, with the sentence of the train's [`error`](Self::error).
    #[must_use]
    pub const fn rigid(&self) -> Rigid {
        if let Some(error) = self.error {
            error.stop()
        }
        Rigid { inertia: self.total_inertia(), gravity_torque: self.gravity }
    }

    /// Natural frequencies and shapes of the free train, and its antiresonances with the motor locked; gaps count as
    /// closed.
    ///
    /// # Panics
    /// At compile time in a constant, with the sentence of the train's [`error`](Self::error).
    #[must_use]
    pub const fn modes(&self) -> Modes {
        if let Some(error) = self.error {
            error.stop()
        }
        let free = self.scaled(false);
        let held = self.scaled(true);
        let mut modes = Modes::of(&self.inertia, self.count - 1, free, held);
        each!(i, 0.., i + 1 < self.count, {
            let mode = modes.mode_mut(i);
            each!(j, 0.., j + 1 < self.count + self.closing, {
                let Joint { from, to, shaft } = self.joint[j];
                let twist = mode.shape[from] - mode.shape[to];
                mode.damping += shaft.damping * twist * twist;
            });
            each!(j, 0..self.count, {
                mode.damping += self.drag[j] * mode.shape[j] * mode.shape[j];
            });
        });
        modes
    }

    /// The transpose of `R B / sqrt(J)`, by columns; without the motor's row where it is locked.
    const fn scaled(&self, held: bool) -> Columns {
        let edges = self.count - 1;
        let root = self.triangle();
        let mut columns = [[0.0; CAPACITY]; SHAFTS];
        each!(row, 0..edges, {
            each!(edge, row..edges, {
                let factor = root[row][edge];
                if factor != 0.0 {
                    let Joint { from, to, .. } = self.joint[edge];
                    if !(held && from == 0) {
                        columns[row][from] += factor / sqrt(self.inertia[from]);
                    }
                    columns[row][to] -= factor / sqrt(self.inertia[to]);
                }
            });
        });
        columns
    }

    /// R with `R^T R` the stiffness of the tree's twists: diagonal without loops, upper triangular with them.
    const fn triangle(&self) -> [[f64; SHAFTS]; TRAIN_SHAFTS] {
        let edges = self.count - 1;
        let mut root = [[0.0; SHAFTS]; TRAIN_SHAFTS];
        each!(j, 0..edges, {
            root[j][j] = sqrt(self.joint[j].shaft.stiffness);
        });
        each!(j, edges..edges + self.closing, {
            // From either end up to the motor: the common part cancels exactly.
            let Joint { from, to, shaft } = self.joint[j];
            let stiff = sqrt(shaft.stiffness);
            let mut node = to;
            while node != 0 {
                root[j][node - 1] += stiff;
                node = self.joint[node - 1].from;
            }
            let mut node = from;
            while node != 0 {
                root[j][node - 1] -= stiff;
                node = self.joint[node - 1].from;
            }
        });
        if self.closing > 0 {
            triangulate(&mut root, edges + self.closing, edges);
        }
        root
    }
}

/// Householder's reflections: rows above the diagonal of the first `columns` columns, nothing below. The first rows have
/// nothing below their diagonal to begin with.
const fn triangulate(matrix: &mut [[f64; SHAFTS]; TRAIN_SHAFTS], rows: usize, columns: usize) {
    each!(c, 0..columns, {
        let mut below = 0.0;
        each!(r, columns..rows, {
            below += matrix[r][c] * matrix[r][c];
        });
        if below > 0.0 {
            let top = matrix[c][c];
            let size = sqrt(top * top + below);
            // Away from the diagonal, so that nothing cancels.
            let lead = if top < 0.0 { top - size } else { top + size };
            let norm = 2.0 / (lead * lead + below);
            each!(k, (c + 1)..columns, {
                let mut product = lead * matrix[c][k];
                each!(r, columns..rows, {
                    product += matrix[r][c] * matrix[r][k];
                });
                product *= norm;
                matrix[c][k] -= product * lead;
                each!(r, columns..rows, {
                    matrix[r][k] -= product * matrix[r][c];
                });
            });
            matrix[c][c] = if top < 0.0 { size } else { -size };
            each!(r, columns..rows, {
                matrix[r][c] = 0.0;
            });
        }
    });
}
