//! The discrete part of the state: contacts, friction, and the flow of power through lossy gears.

use super::chain::Chain;
use super::dense::dot;
use super::layout::Layout;

/// Motion of a node that has no dry friction and no lossy gear.
pub(super) const FREE: i8 = 2;
/// Times its side: a contact that is still closed, but whose damper has taken its torque to zero.
pub(super) const TRAILING: i8 = 2;

/// Which linear stretch is running.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) struct Mode {
    /// Of each shaft: -1, 0, +1, or a side times [`TRAILING`].
    pub contact: Vec<i8>,
    /// Of each node: -1, +1, 0 held, or [`FREE`].
    pub motion: Vec<i8>,
    /// Of each shaft: the sign of its torque, kept only where a lossy gear needs it.
    pub flow: Vec<i8>,
}

impl Mode {
    /// Whether the shaft carries torque.
    pub fn carries(&self, chain: &Chain, shaft: usize) -> bool {
        chain.shafts[shaft].is_linear() || self.contact[shaft].abs() == 1
    }

    pub fn is_held(&self, node: usize) -> bool {
        self.motion[node] == 0
    }

    /// Torque on the node before the shaft, as a multiple of the shaft's `[Huang 1987 tables 1-2 to 1-4]`.
    pub fn loss(&self, chain: &Chain, shaft: usize) -> f64 {
        let gear = &chain.nodes[shaft];
        match self.motion[shaft] * self.flow[shaft] {
            1 => 1.0 / gear.efficiency,
            -1 => gear.back_efficiency,
            _ => 1.0,
        }
    }

    /// Part of the mode that determines the matrices.
    pub fn key(&self, chain: &Chain) -> Vec<i8> {
        let shafts = (0..chain.shafts.len()).map(|s| {
            let lossy = chain.nodes[s].is_lossy() && self.carries(chain, s);
            i8::from(self.carries(chain, s))
                + if lossy && !self.is_held(s) { 4 * self.motion[s] * self.flow[s] } else { 0 }
        });
        shafts.chain(self.motion.iter().map(|&m| i8::from(m == 0))).collect()
    }

    /// Torques on the nodes that the mode itself brings: origins of the contacts and dry friction, N m.
    pub fn torques(&self, chain: &Chain, coulomb: &[f64]) -> Vec<f64> {
        let mut torques = vec![0.0; chain.nodes.len()];
        for (s, shaft) in chain.shafts.iter().enumerate() {
            if self.carries(chain, s) {
                let offset = shaft.stiffness * shaft.origin(self.contact[s]);
                torques[s] += self.loss(chain, s) * offset;
                torques[s + 1] -= offset;
            }
        }
        for (j, torque) in torques.iter_mut().enumerate() {
            if self.motion[j].abs() == 1 {
                *torque -= f64::from(self.motion[j]) * coulomb[j];
            }
        }
        torques
    }
}

/// The elastic torque of a shaft as a linear form in the state: row and constant.
pub(super) fn elastic_torque(chain: &Chain, mode: &Mode, shaft: usize) -> (Vec<f64>, f64) {
    let layout = Layout { nodes: chain.nodes.len() };
    let mut row = vec![0.0; layout.states()];
    if !mode.carries(chain, shaft) {
        return (row, 0.0);
    }
    let link = &chain.shafts[shaft];
    row[shaft] = link.stiffness;
    row[layout.speed(shaft)] = link.damping;
    row[layout.speed(shaft + 1)] = -link.damping;
    (row, -link.stiffness * link.origin(mode.contact[shaft]))
}

/// Which torques hold a node at rest: `push`, what drives it but for friction and its gear's reaction, and the band
/// that these two can balance.
pub(super) struct Hold {
    pub push: f64,
    /// Reaction of the gear, lowest and highest, N m.
    pub reaction: (f64, f64),
    pub coulomb: f64,
}

impl Hold {
    pub fn new(chain: &Chain, mode: &Mode, x: &[f64], outer: &[f64], coulomb: &[f64], node: usize) -> Self {
        let torque = |s: usize| {
            let (row, constant) = elastic_torque(chain, mode, s);
            dot(&row, x) + constant
        };
        let before = if node > 0 { torque(node - 1) } else { 0.0 };
        let behind = if node < chain.shafts.len() { torque(node) } else { 0.0 };
        let gear = &chain.nodes[node];
        let (one, other) = (behind * gear.back_efficiency, behind / gear.efficiency);
        Self { push: outer[node] + before, reaction: (one.min(other), one.max(other)), coulomb: coulomb[node] }
    }

    /// The direction in which the node starts, or 0 if it is held.
    pub fn direction(&self) -> i8 {
        if self.push > self.reaction.1 + self.coulomb {
            1
        } else if self.push < self.reaction.0 - self.coulomb {
            -1
        } else {
            0
        }
    }

    /// The gear's reaction while held, N m: the gear takes what it can, friction the rest.
    pub fn gear_torque(&self) -> f64 {
        // `clamp` panics where a run that overflowed has made the band NaN
        self.push.max(self.reaction.0).min(self.reaction.1)
    }

    /// Dry friction while held, N m, positive against positive motion.
    pub fn friction(&self) -> f64 {
        (self.push - self.gear_torque()).max(-self.coulomb).min(self.coulomb)
    }
}

#[cfg(test)]
mod tests {
    use super::Hold;

    /// Without a panic, which would end the program of a simulation tool.
    #[test]
    fn a_band_that_overflowed_gives_no_number() {
        let hold = Hold { push: 1.0, reaction: (f64::INFINITY, f64::NEG_INFINITY), coulomb: 0.0 };
        assert!(!hold.gear_torque().is_finite());
        let hold = Hold { push: f64::NAN, reaction: (f64::NAN, f64::NAN), coulomb: 0.0 };
        assert!(hold.gear_torque().is_nan());
        assert_eq!(hold.direction(), 0);
    }
}
