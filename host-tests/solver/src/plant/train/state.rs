//! State of a train at one moment: its continuous state, and the mode of its smooth stretch.

use nalgebra::DMatrix;

use super::Train;
use super::pins::Pinning;
use super::rigid_gear::Flow;

/// Times its side: a contact that is still closed, but whose damper has taken its force to zero.
pub(super) const TRAILING: i8 = 2;

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
    /// Of each link: -1, 0, +1, or a side times [`TRAILING`].
    pub contact: Vec<i8>,
    /// Of each friction: the direction it slides in, 0 while it sticks.
    pub slip: Vec<i8>,
    /// Of each link: the sign of its torque on its first coordinate, kept only where a lossy gear needs it.
    pub flow: Vec<i8>,
    /// Gears with no shaft behind them.
    pub gears: Vec<Flow>,
    /// Arcs as coordinate and source, and how many of their ends have been passed; odd on the arc. So are sources whose
    /// pieces follow the speed.
    pub arcs: Vec<(usize, usize, i64)>,
    /// Cranks with friction in their pins.
    pub pins: Vec<Pinning>,
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

    /// Force on the first coordinate of a link, as a multiple of its own `[Huang 1987 tables 1-2 to 1-4]`.
    pub fn loss(&self, train: &Train, link: usize) -> f64 {
        if !train.links[link].is_lossy() {
            return 1.0;
        }
        let gear = train.frictions.iter().position(|friction| friction.losses.contains(&link));
        match gear.map_or(0, |s| self.slip[s]) * self.flow[link] {
            0 => 1.0,
            power => train.links[link].factor(power > 0),
        }
    }

    pub fn on_arc(&self, coordinate: usize, source: usize) -> bool {
        self.passed(coordinate, source).rem_euclid(2) == 1
    }

    /// Ends of a source's arcs or pieces that have been passed.
    pub fn passed(&self, coordinate: usize, source: usize) -> i64 {
        self.arcs.iter().find(|&&(j, s, _)| j == coordinate && s == source).map_or(0, |arc| arc.2)
    }

    /// The tooth edge ahead of a link.
    pub fn edge(&self, link: usize) -> i64 {
        self.teeth.iter().find(|tooth| tooth.0 == link).map_or(0, |tooth| tooth.1)
    }

    /// The pins of a coordinate's crank.
    pub fn pinning(&self, coordinate: usize) -> Option<&Pinning> {
        self.pins.iter().find(|pinning| pinning.at == coordinate)
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
