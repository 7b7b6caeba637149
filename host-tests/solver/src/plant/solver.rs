//! The plant: state, settings, and what is kept of the regimes met so far.

use std::collections::HashMap;

use super::chain::Chain;
use super::error::{PlantError, not_negative};
use super::event::{Event, Place};
use super::excitation::MotorLaw;
use super::extremes::Extremes;
use super::guard::{Guard, guards};
use super::layout::Layout;
use super::mode::{FREE, Hold, Mode, elastic_torque};
use super::regime::Regime;
use super::shaft::Shaft;

/// Default time within which an event is located, s.
pub(super) const EVENT_TOLERANCE: f64 = 1e-14;

/// A running chain. Built by [`Chain::build`]; a clone runs on independently.
#[derive(Debug, Clone)]
pub struct Plant {
    pub(super) chain: Chain,
    pub(super) layout: Layout,
    /// Twists, speeds, angle of the motor.
    pub(super) x: Vec<f64>,
    pub(super) next: Vec<f64>,
    pub(super) rate: Vec<f64>,
    /// Time at the last end of a tick, s, with what its rounding has lost.
    pub(super) clock: (f64, f64),
    /// Time since then, s: not zero only within a tick.
    pub(super) elapsed: f64,
    pub(super) held_torque: f64,
    pub(super) brakes: Vec<f64>,
    /// Dry friction of every node, brakes included, N m.
    pub(super) coulomb: Vec<f64>,
    /// Outer torques on the nodes (motor less loads), N m, and their rates, N m/s.
    pub(super) outer: Vec<f64>,
    pub(super) outer_rate: Vec<f64>,
    pub(super) ramped: bool,
    pub(super) mode_torque: Vec<f64>,
    pub(super) mode: Mode,
    pub(super) settled: bool,
    pub(super) regimes: Vec<Regime>,
    pub(super) index: HashMap<Vec<i8>, usize>,
    pub(super) current: usize,
    pub(super) guards: Vec<Guard>,
    pub(super) events: Vec<Event>,
    pub(super) event_tolerance: f64,
    pub(super) extremes: Option<Vec<Extremes>>,
    pub(super) refused: u64,
}

impl Chain {
    /// Checks every number and readies the plant.
    ///
    /// # Errors
    /// [`PlantError`] names the first parameter that is out of range.
    pub fn build(self) -> Result<Plant, PlantError> {
        self.validate()?;
        Plant::new(self)
    }
}

impl Plant {
    fn new(chain: Chain) -> Result<Self, PlantError> {
        let n = chain.nodes.len();
        let layout = Layout { nodes: n };
        let (twists, speeds) = chain.start.state(&chain);
        let x: Vec<f64> = twists.into_iter().chain(speeds).chain([0.0]).collect();
        let coulomb: Vec<f64> = chain.nodes.iter().map(|node| node.coulomb).collect();
        let mode = Mode { contact: vec![0; n - 1], motion: vec![FREE; n], flow: vec![1; n - 1] };
        let m = layout.states();
        let mut plant = Self {
            chain,
            layout,
            next: vec![0.0; m],
            rate: vec![0.0; m],
            x,
            clock: (0.0, 0.0),
            elapsed: 0.0,
            held_torque: 0.0,
            brakes: vec![0.0; n],
            coulomb,
            outer: vec![0.0; n],
            outer_rate: vec![0.0; n],
            ramped: false,
            mode_torque: vec![0.0; n],
            mode,
            settled: false,
            regimes: Vec::new(),
            index: HashMap::new(),
            current: 0,
            guards: Vec::new(),
            events: Vec::new(),
            event_tolerance: EVENT_TOLERANCE,
            extremes: None,
            refused: 0,
        };
        plant.settle_contacts();
        plant.set_outer(0.0);
        plant.settle_motion();
        plant.enter_mode();
        Ok(plant)
    }

    /// Replaces the constant load torque of a node, N m, positive against positive speed. A node that is not there or a
    /// number that is not finite changes nothing and counts as [`refused`](Self::refused).
    pub fn set_load_torque(&mut self, node: usize, torque: f64) {
        if node >= self.chain.nodes.len() || !torque.is_finite() {
            self.refused += 1;
            return;
        }
        self.chain.nodes[node].load = torque;
        self.set_outer(self.clock.0);
    }

    /// Sets the torque of a holding brake on a node, N m, zero or above: dry friction beside the node's own; 0 releases
    /// it. Bad input changes nothing and counts as [`refused`](Self::refused).
    pub fn set_brake(&mut self, node: usize, torque: f64) {
        let valid = not_negative("brake torque", Place::Node(node), torque).is_ok();
        if node >= self.chain.nodes.len() || !valid {
            self.refused += 1;
            return;
        }
        self.brakes[node] = torque;
        self.coulomb[node] = self.chain.nodes[node].coulomb + torque;
        let dry = self.is_dry(node);
        if !dry {
            self.mode.motion[node] = FREE;
        } else if self.mode.motion[node] == FREE {
            self.settle_node(node);
        }
        self.enter_mode();
    }

    /// A rope has been wound up or paid out: stiffness, N m/rad, above zero, and damping, N m s/rad, zero or above, of
    /// a shaft change. Its elastic torque stays: the wound part keeps its stretch on the drum. Bad input changes
    /// nothing and counts as [`refused`](Self::refused).
    pub fn set_shaft(&mut self, shaft: usize, stiffness: f64, damping: f64) {
        let Some(old) = self.chain.shafts.get(shaft).copied() else {
            self.refused += 1;
            return;
        };
        let new = Shaft { stiffness, damping, ..old };
        if new.validate(shaft).is_err() {
            self.refused += 1;
            return;
        }
        self.x[shaft] = old.wound(&new, self.mode.contact[shaft], self.x[shaft]);
        self.chain.shafts[shaft] = new;
        self.regimes.clear();
        self.index.clear();
        self.enter_mode();
    }

    /// Replaces the motor's own law. Its time is the plant's.
    ///
    /// # Errors
    /// [`PlantError::Parameter`] for a number out of range; the old law then stays.
    pub fn set_motor_law(&mut self, law: MotorLaw) -> Result<(), PlantError> {
        law.validate()?;
        self.chain.law = law;
        self.regimes.clear();
        self.index.clear();
        self.set_outer(self.clock.0);
        self.enter_mode();
        Ok(())
    }

    /// Time within which an event is located, s, 1e-14 unless set; not below the resolution of the tick. Zero or above;
    /// anything else counts as [`refused`](Self::refused).
    pub fn set_event_tolerance(&mut self, seconds: f64) {
        if seconds.is_finite() && seconds >= 0.0 {
            self.event_tolerance = seconds;
        } else {
            self.refused += 1;
        }
    }

    /// Calls with bad input that were ignored.
    #[must_use]
    pub fn refused(&self) -> u64 {
        self.refused
    }

    pub(super) fn is_dry(&self, node: usize) -> bool {
        self.coulomb[node] > 0.0 || self.chain.nodes[node].is_lossy()
    }

    pub(super) fn hold(&self, node: usize) -> Hold {
        Hold::new(&self.chain, &self.mode, &self.x, &self.outer, &self.coulomb, node)
    }

    /// Motion of a dry node from its speed, or from the torques on it when it has none.
    pub(super) fn settle_node(&mut self, node: usize) {
        let speed = self.x[self.layout.speed(node)];
        self.mode.motion[node] = if speed == 0.0 { self.hold(node).direction() } else { speed.signum() as i8 };
    }

    pub(super) fn settle_motion(&mut self) {
        for j in 0..self.chain.nodes.len() {
            if self.is_dry(j) {
                self.settle_node(j);
            }
        }
    }

    fn settle_contacts(&mut self) {
        for s in 0..self.chain.shafts.len() {
            let (shaft, twist) = (self.chain.shafts[s], self.x[s]);
            let reach = shaft.origin(1);
            self.mode.contact[s] = match twist {
                _ if shaft.is_linear() => 1,
                t if t > reach => 1,
                t if t < -reach && !shaft.rope => -1,
                _ => 0,
            };
            let (torque, contact) = (self.elastic(s), self.mode.contact[s]);
            self.mode.flow[s] = if torque < 0.0 { -1 } else { 1 };
            if !shaft.is_linear() && torque * f64::from(contact) < 0.0 {
                self.mode.contact[s] = contact * super::mode::TRAILING;
            }
        }
    }

    /// Torque of the shaft before any gear loss, N m.
    pub(super) fn elastic(&self, shaft: usize) -> f64 {
        let (row, constant) = elastic_torque(&self.chain, &self.mode, shaft);
        super::dense::dot(&row, &self.x) + constant
    }

    /// Outer torques at `time`.
    pub(super) fn set_outer(&mut self, time: f64) {
        self.ramped = false;
        for (j, node) in self.chain.nodes.iter().enumerate() {
            let (load, load_rate) = node.program.as_ref().map_or((0.0, 0.0), |p| p.at(time));
            let (motor, motor_rate) = if j == 0 {
                let (torque, rate) = self.chain.law.torque(time);
                (self.held_torque + torque, rate)
            } else {
                (0.0, 0.0)
            };
            self.outer[j] = motor - node.load - load;
            self.outer_rate[j] = motor_rate - load_rate;
            self.ramped |= self.outer_rate[j] != 0.0;
        }
    }

    /// Makes the matrices and the guards those of the mode.
    pub(super) fn enter_mode(&mut self) {
        let key = self.mode.key(&self.chain);
        self.current = match self.index.get(&key) {
            Some(&known) => known,
            None => {
                self.regimes.push(Regime::new(&self.chain, &self.mode));
                self.index.insert(key, self.regimes.len() - 1);
                self.regimes.len() - 1
            }
        };
        self.mode_torque = self.mode.torques(&self.chain, &self.coulomb);
        self.guards = guards(&self.chain, &self.mode, &self.regimes[self.current], &self.coulomb);
    }
}
