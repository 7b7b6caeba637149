//! The description of a chain, from the motor outwards, and how its run begins: the start conditions of
//! `[derived; headings: Huang 1987 ch. 3 to 7]`.

use super::error::{PlantError, finite, in_range, not_negative, positive};
use super::event::Place;
use super::excitation::LoadProgram;
use super::shaft::Shaft;
use super::train::Source;

/// One inertia and what acts on it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Node {
    pub inertia: f64,
    pub viscous: f64,
    pub coulomb: f64,
    pub load: f64,
    pub efficiency: f64,
    /// With the shaft behind driving.
    pub back_efficiency: f64,
    /// Torques beside, positive in the positive direction.
    pub sources: Vec<Source>,
}

impl Node {
    fn new(inertia: f64) -> Self {
        Self {
            inertia,
            viscous: 0.0,
            coulomb: 0.0,
            load: 0.0,
            efficiency: 1.0,
            back_efficiency: 1.0,
            sources: Vec::new(),
        }
    }
}

/// A chain of inertias, written from the motor to the load. Properties belong to the node named last.
///
/// ```
/// use driveline_solver::plant::{Chain, Shaft, Start};
/// // motor, gear box and drum, load on a rope that must be wound up by 0.5 rad of the motor before it pulls
/// let hoist = Chain::motor(0.62).viscous(0.01)
///     .shaft(Shaft::elastic(5.0e4).damping(2.0).gap(0.01), 0.08).efficiency(0.94)
///     .shaft(Shaft::rope(900.0).damping(0.5).gap(0.5), 0.35).load(120.0).coulomb(200.0)
///     .start(Start::Slack)
///     .build()?;
/// # Ok::<(), driveline_solver::plant::PlantError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Chain {
    pub(super) nodes: Vec<Node>,
    pub(super) shafts: Vec<Shaft>,
    pub(super) start: Start,
}

impl Chain {
    /// Begins with the motor's inertia, kg m2, above zero.
    #[must_use]
    pub fn motor(inertia: f64) -> Self {
        Self { nodes: vec![Node::new(inertia)], shafts: Vec::new(), start: Start::Rest }
    }

    /// Goes on by a shaft to the next inertia, kg m2, above zero.
    #[must_use]
    pub fn shaft(mut self, shaft: Shaft, inertia: f64) -> Self {
        self.shafts.push(shaft);
        self.nodes.push(Node::new(inertia));
        self
    }

    /// Viscous friction of the last node, N m s/rad, zero or above.
    #[must_use]
    pub fn viscous(self, viscous: f64) -> Self {
        self.last(|node| node.viscous = viscous)
    }

    /// Coulomb friction of the last node, N m, zero or above. It holds the node at rest up to this torque.
    #[must_use]
    pub fn coulomb(self, torque: f64) -> Self {
        self.last(|node| node.coulomb = torque)
    }

    /// Constant load torque of the last node, N m, positive against positive speed.
    #[must_use]
    pub fn load(self, torque: f64) -> Self {
        self.last(|node| node.load = torque)
    }

    /// Load program of the last node, added to its constant load.
    #[must_use]
    pub fn program(self, program: LoadProgram) -> Self {
        self.last(|node| node.sources.push(Source::Program(program.negated())))
    }

    /// Efficiency, above 0 and up to 1, of a gear at the last node, between it and the shaft that follows. The node
    /// carries `T/eta` when motoring and `eta T` when overhauling, and sticks in between at rest
    /// `[Huang 1987 tables 1-2 to 1-4]`. Refused at the end of the chain, where no shaft follows.
    #[must_use]
    pub fn efficiency(self, efficiency: f64) -> Self {
        self.last(|node| (node.efficiency, node.back_efficiency) = (efficiency, efficiency))
    }

    /// Efficiency, up to 1, of the last node's gear while the shaft behind it drives: a worm keeps less of the power
    /// backwards, and locks itself at zero or below. Call it after [`Self::efficiency`], which sets both.
    #[must_use]
    pub fn back_efficiency(self, efficiency: f64) -> Self {
        self.last(|node| node.back_efficiency = efficiency)
    }

    /// How the plant starts; at rest without twist if not said.
    #[must_use]
    pub fn start(mut self, start: Start) -> Self {
        self.start = start;
        self
    }

    /// The motor's own torque, beside the held one.
    #[must_use]
    pub fn motor_law(mut self, law: Source) -> Self {
        self.nodes[0].sources.push(law);
        self
    }

    /// Number of inertias.
    #[must_use]
    pub fn nodes(&self) -> usize {
        self.nodes.len()
    }

    fn last(mut self, change: impl FnOnce(&mut Node)) -> Self {
        if let Some(node) = self.nodes.last_mut() {
            change(node);
        }
        self
    }

    pub(super) fn validate(&self) -> Result<(), PlantError> {
        for (j, node) in self.nodes.iter().enumerate() {
            let place = Place::Node(j);
            positive("inertia", place, node.inertia)?;
            not_negative("viscous friction", place, node.viscous)?;
            not_negative("Coulomb friction", place, node.coulomb)?;
            finite("load torque", place, node.load)?;
            let has_shaft = j < self.shafts.len();
            let (eta, back) = (node.efficiency, node.back_efficiency);
            in_range("efficiency", place, eta, eta > 0.0 && eta <= 1.0, "above 0 and up to 1")?;
            in_range("back efficiency", place, back, back <= 1.0, "up to 1")?;
            for (name, eta) in [("efficiency", eta), ("back efficiency", back)] {
                in_range(name, place, eta, has_shaft || eta == 1.0, "a shaft behind the gear")?;
            }
            node.sources.iter().try_for_each(|source| source.validate(place))?;
        }
        for (s, shaft) in self.shafts.iter().enumerate() {
            shaft.validate(s)?;
        }
        self.start.validate(self)
    }
}

/// The state at time zero. The motor's angle is zero.
#[derive(Debug, Clone, PartialEq)]
pub enum Start {
    /// No speed and no twist.
    Rest,
    /// No speed, every backlash open to its far flank (twist `-G/2`), ropes without tension at zero twist.
    Slack,
    /// The loads and frictions carried at a steady speed, rad/s, without vibration. At zero speed the constant loads
    /// alone are carried and friction is left out.
    Pretensioned {
        /// Of every node, rad/s.
        speed: f64,
    },
    Given {
        /// Of every shaft, rad.
        twists: Vec<f64>,
        /// Of every node, rad/s.
        speeds: Vec<f64>,
    },
}

impl Start {
    fn validate(&self, chain: &Chain) -> Result<(), PlantError> {
        match self {
            Start::Rest | Start::Slack => Ok(()),
            Start::Pretensioned { speed } => {
                finite("starting speed", Place::Node(0), *speed)?;
                let torques = carried_torques(chain, *speed);
                for (s, (shaft, torque)) in chain.shafts.iter().zip(torques).enumerate() {
                    if shaft.rope && torque < 0.0 {
                        return Err(PlantError::Parameter {
                            name: "torque to be carried",
                            place: Place::Shaft(s),
                            value: torque,
                            expected: "zero or above, since a rope cannot push",
                        });
                    }
                }
                Ok(())
            }
            Start::Given { twists, speeds } => {
                count("starting twists", twists.len(), chain.shafts.len())?;
                count("starting speeds", speeds.len(), chain.nodes.len())?;
                for (s, &twist) in twists.iter().enumerate() {
                    finite("starting twist", Place::Shaft(s), twist)?;
                }
                for (j, &speed) in speeds.iter().enumerate() {
                    finite("starting speed", Place::Node(j), speed)?;
                }
                Ok(())
            }
        }
    }

    /// Twists (rad) and speeds (rad/s) at time zero, of a chain that was found valid.
    pub(super) fn state(&self, chain: &Chain) -> (Vec<f64>, Vec<f64>) {
        let still = vec![0.0; chain.nodes.len()];
        match self {
            Start::Rest => (vec![0.0; chain.shafts.len()], still),
            Start::Slack => {
                let open = |s: &Shaft| if s.rope { 0.0 } else { -0.5 * s.gap };
                (chain.shafts.iter().map(open).collect(), still)
            }
            Start::Pretensioned { speed } => {
                let torques = carried_torques(chain, *speed);
                let twists = chain.shafts.iter().zip(torques).map(|(shaft, torque)| {
                    let side = if torque < 0.0 { -1 } else { 1 };
                    torque / shaft.stiffness + shaft.origin(side)
                });
                (twists.collect(), vec![*speed; chain.nodes.len()])
            }
            Start::Given { twists, speeds } => (twists.clone(), speeds.clone()),
        }
    }
}

/// Torque of every shaft at a steady speed, N m: the sum of what lies behind it, gear losses paid by the driving side.
fn carried_torques(chain: &Chain, speed: f64) -> Vec<f64> {
    let direction = if speed == 0.0 { 0.0 } else { speed.signum() };
    let mut torques = vec![0.0; chain.shafts.len()];
    let mut behind = 0.0;
    for s in (0..chain.shafts.len()).rev() {
        let node = &chain.nodes[s + 1];
        let program = |source: &Source| if let Source::Program(program) = source { -program.at(0.0).0 } else { 0.0 };
        let program: f64 = node.sources.iter().map(program).sum();
        let through = match direction * behind {
            power if power > 0.0 => behind / node.efficiency,
            power if power < 0.0 => behind * node.back_efficiency,
            _ => behind,
        };
        behind = through + node.load + program + node.viscous * speed + node.coulomb * direction;
        torques[s] = behind;
    }
    torques
}

fn count(name: &'static str, found: usize, expected: usize) -> Result<(), PlantError> {
    if found == expected { Ok(()) } else { Err(PlantError::Count { name, found, expected }) }
}
