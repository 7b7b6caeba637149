//! A scene's full plant as the closed loop drives it: a chain, or a train of any shape, with the record of what was
//! done to it.

use driveline_solver::plant::Plant;
use driveline_solver::plant::converge;
use driveline_solver::plant::converge::Recording;
use driveline_solver::plant::converge::{NotProven, Proof};
use driveline_solver::plant::train;
use driveline_solver::plant::train::{Motion, Signal};

/// The plant, recorded from its start on. Nodes and shafts are those of the chain, or coordinates and links of the
/// train; the motor is node 0.
#[derive(Clone, Debug)]
pub enum Body {
    /// Referred to the motor as it is.
    Chain(Box<Recording>),
    /// The same without a record of its run, for many runs that are not proven one by one.
    Unrecorded(Box<Plant>),
    /// Each coordinate on its own shaft, referred here.
    Train(Box<Referred>),
}

/// A train with what refers its coordinates to the motor.
#[derive(Clone, Debug)]
pub struct Referred {
    recording: train::converge::Recording,
    ratios: Vec<f64>,
}

impl From<Plant> for Body {
    fn from(plant: Plant) -> Self {
        Body::Chain(Box::new(Recording::new(plant)))
    }
}

impl Body {
    /// A train of which some coordinates turn slower than the motor, by these ratios; the others turn with it.
    pub fn train(motion: Motion, slower: &[(usize, f64)]) -> Self {
        let mut ratios = vec![1.0; motion.coordinates()];
        for &(coordinate, ratio) in slower {
            ratios[coordinate] = ratio;
        }
        let recording = train::converge::Recording::new(motion);
        Body::Train(Box::new(Referred { recording, ratios }))
    }

    /// The same plant without a record of its run, where it is a chain.
    #[must_use]
    pub fn unrecorded(&self) -> Self {
        match self {
            Body::Chain(chain) => Body::Unrecorded(Box::new(chain.plant().clone())),
            other => other.clone(),
        }
    }

    /// The chain; none of a train.
    fn chain(&self) -> Result<&Plant, &Referred> {
        match self {
            Body::Chain(chain) => Ok(chain.plant()),
            Body::Unrecorded(plant) => Ok(plant),
            Body::Train(train) => Err(train),
        }
    }

    /// Angle of the motor (rad).
    pub fn motor_angle(&self) -> f64 {
        match self.chain() {
            Ok(plant) => plant.motor_angle(),
            Err(train) => train.recording.motion().angle(0),
        }
    }

    /// Speed of the motor (rad/s).
    pub fn motor_speed(&self) -> f64 {
        self.speed(0)
    }

    /// Speed of a node, referred to the motor (rad/s).
    pub fn speed(&self, node: usize) -> f64 {
        match self.chain() {
            Ok(plant) => plant.speed(node),
            Err(train) => train.recording.motion().speed(node) * train.ratios[node],
        }
    }

    /// How many nodes there are.
    pub fn nodes(&self) -> usize {
        match self.chain() {
            Ok(plant) => plant.nodes(),
            Err(train) => train.ratios.len(),
        }
    }

    /// Inertia of a node, referred to the motor (kg m2); NaN where a crank changes it.
    pub fn inertia(&self, node: usize) -> f64 {
        match self.chain() {
            Ok(plant) => plant.inertia(node),
            Err(train) => train.recording.motion().inertia(node) / train.ratios[node].powi(2),
        }
    }

    /// Angular momentum of all nodes about the motor's shaft (N m s); NaN where a crank changes an inertia.
    pub fn momentum(&self) -> f64 {
        (0..self.nodes()).map(|node| self.inertia(node) * self.speed(node)).sum()
    }

    /// Whether a gap is open or a rope slack now.
    pub fn is_open(&self) -> bool {
        match self.chain() {
            Ok(plant) => plant.is_open(),
            Err(train) => train.recording.motion().is_open(),
        }
    }

    /// Whether it has backlash anywhere; a rope is none.
    pub fn has_backlash(&self) -> bool {
        match self.chain() {
            Ok(plant) => plant.has_backlash(),
            Err(train) => train.recording.motion().has_backlash(),
        }
    }

    /// Twist of a shaft of a chain, referred to the motor, or elongation of a link of a train [rad or m].
    pub fn twist(&self, shaft: usize) -> f64 {
        match self.chain() {
            Ok(plant) => plant.twist(shaft),
            Err(train) => train.recording.motion().elongation(shaft),
        }
    }

    /// Torque of a shaft of a chain as [`Plant::shaft_torque`], or force of a link of a train (N m or N).
    pub fn shaft_torque(&self, shaft: usize) -> f64 {
        match self.chain() {
            Ok(plant) => plant.shaft_torque(shaft),
            Err(train) => train.recording.motion().force(shaft),
        }
    }

    /// Torque on a node from outside, against positive motion, referred to the motor (N m).
    pub fn load_torque(&self, node: usize) -> f64 {
        match self.chain() {
            Ok(plant) => plant.load_torque(node),
            Err(train) => -train.recording.motion().read(Signal::Outside(node)) / train.ratios[node],
        }
    }

    /// Torque of a shaft of a chain as [`Plant::torque_behind_gear`], or force of a link of a train (N m or N).
    pub fn torque_behind_gear(&self, shaft: usize) -> f64 {
        match self.chain() {
            Ok(plant) => plant.torque_behind_gear(shaft),
            Err(train) => train.recording.motion().force(shaft),
        }
    }

    /// Changes a node's load torque, referred to the motor (N m).
    pub fn set_load_torque(&mut self, node: usize, torque: f64) {
        match self {
            Body::Chain(chain) => chain.set_load_torque(node, torque),
            Body::Unrecorded(plant) => plant.set_load_torque(node, torque),
            Body::Train(train) => train.recording.set_torque(node, -torque * train.ratios[node]),
        }
    }

    /// Closes a node's brake with this torque (N m); 0 opens it.
    ///
    /// # Panics
    /// For a train, whose frictions are parts of it: a scene that brakes one so is written wrongly.
    pub fn set_brake(&mut self, node: usize, torque: f64) {
        match self {
            Body::Chain(chain) => chain.set_brake(node, torque),
            Body::Unrecorded(plant) => plant.set_brake(node, torque),
            Body::Train(_) => panic!("a train has no brake at node {node}: add a friction"),
        }
    }

    /// Winds a rope up or pays it out: stiffness (N m/rad) and damping (N m s/rad) of a shaft of a chain.
    ///
    /// # Panics
    /// For a train, whose links stay as they are: a scene that winds one is written wrongly.
    pub fn set_shaft(&mut self, shaft: usize, stiffness: f64, damping: f64) {
        match self {
            Body::Chain(chain) => chain.set_shaft(shaft, stiffness, damping),
            Body::Unrecorded(plant) => plant.set_shaft(shaft, stiffness, damping),
            Body::Train(_) => panic!("a train has no rope at link {shaft}"),
        }
    }

    /// Runs on by `dt` (s) under a torque of the motor (N m).
    pub fn advance(&mut self, torque: f64, dt: f64) {
        match self {
            Body::Chain(chain) => chain.advance(torque, dt),
            Body::Unrecorded(plant) => plant.advance(torque, dt),
            Body::Train(train) => {
                train.recording.set_torque(0, torque);
                train.recording.advance(dt);
            }
        }
    }

    /// Proves the run so far.
    ///
    /// # Errors
    /// [`NotProven`] if it was not recorded, or if another integrator, or the solver with tighter events, comes out
    /// otherwise.
    pub fn prove(&self) -> Result<Proof, NotProven> {
        match self {
            Body::Chain(chain) => converge::prove(chain),
            Body::Unrecorded(_) => Err(NotProven::Empty),
            Body::Train(train) => train::converge::prove(&train.recording),
        }
    }

    /// The motion of a train; none of a chain.
    pub fn motion(&self) -> Option<&Motion> {
        match self {
            Body::Chain(_) | Body::Unrecorded(_) => None,
            Body::Train(train) => Some(train.recording.motion()),
        }
    }
}
