//! A chain in motion: the train that it is, from the motor outwards.

use std::ops::{Deref, DerefMut};

use super::super::chain::Chain;
use super::super::error::{PlantError, not_negative};
use super::super::event::Place;
use super::{Coordinate, Friction, Link, Motion, Signal, Source, Train};

/// A running chain, of which a node is a coordinate and a shaft a link. Built by [`Chain::build`]; a clone runs on
/// independently.
#[derive(Debug, Clone)]
pub struct Plant {
    pub(super) motion: Motion,
    /// Constant load and dry friction of every node, N m.
    loads: Vec<f64>,
    pub(super) coulomb: Vec<f64>,
    refused: u64,
}

impl Chain {
    /// Checks every number and readies the plant.
    ///
    /// # Errors
    /// [`PlantError`] names the first parameter that is out of range.
    pub fn build(self) -> Result<Plant, PlantError> {
        self.validate()?;
        let (twists, speeds) = self.start.state(&self);
        let mut train = Train::new();
        let mut angle = 0.0;
        for (j, node) in self.nodes.iter().enumerate() {
            let mut coordinate = Coordinate::new(node.inertia).viscous(node.viscous).speed(speeds[j]).angle(angle);
            angle -= twists.get(j).copied().unwrap_or(0.0);
            for source in node.sources.iter().cloned() {
                coordinate = coordinate.source(source);
            }
            train = train.coordinate(coordinate);
            if node.coulomb > 0.0 {
                train = train.friction(Friction::ground(j, node.coulomb));
            }
        }
        for (s, (shaft, twist)) in self.shafts.iter().zip(twists).enumerate() {
            let gear = &self.nodes[s];
            let link = Link::shaft(s, s + 1, shaft.stiffness).damping(shaft.damping).gap(shaft.gap).elongated(twist);
            let link = link.efficiency(gear.efficiency).back_efficiency(gear.back_efficiency);
            train = train.link(if shaft.rope { link.rope() } else { link });
        }
        let mut motion = train.build()?;
        let loads: Vec<f64> = self.nodes.iter().map(|node| node.load).collect();
        loads.iter().enumerate().for_each(|(j, load)| motion.set_torque(j, -load));
        Ok(Plant { motion, loads, coulomb: self.nodes.iter().map(|node| node.coulomb).collect(), refused: 0 })
    }
}

impl Deref for Plant {
    type Target = Motion;

    fn deref(&self) -> &Motion {
        &self.motion
    }
}

impl DerefMut for Plant {
    fn deref_mut(&mut self) -> &mut Motion {
        &mut self.motion
    }
}

impl Plant {
    /// Runs on by `dt` seconds (above zero) with `motor_torque` (N m) held, beside the motor's own sources.
    ///
    /// Exact up to rounding between events; ticks of equal length share their matrices. A torque that is not finite or
    /// a length that is not above zero changes nothing and counts as [`refused`](Self::refused).
    pub fn advance(&mut self, motor_torque: f64, dt: f64) {
        if !(motor_torque.is_finite() && dt.is_finite() && dt > 0.0) {
            self.refused += 1;
            return;
        }
        self.motion.set_torque(0, motor_torque - self.loads[0]);
        self.motion.advance(dt);
    }

    /// Replaces the constant load torque of a node, N m, positive against positive speed. A node that is not there or a
    /// number that is not finite changes nothing and counts as [`refused`](Self::refused).
    pub fn set_load_torque(&mut self, node: usize, torque: f64) {
        let Some(load) = self.loads.get_mut(node).filter(|_| torque.is_finite()) else {
            self.refused += 1;
            return;
        };
        let held = self.motion.held[node] + std::mem::replace(load, torque);
        self.motion.set_torque(node, held - torque);
    }

    /// Sets the torque of a holding brake on a node, N m, zero or above: dry friction beside the node's own; 0 releases
    /// it. Bad input changes nothing and counts as [`refused`](Self::refused).
    pub fn set_brake(&mut self, node: usize, torque: f64) {
        match self.coulomb.get(node).filter(|_| not_negative("brake torque", Place::Node(node), torque).is_ok()) {
            Some(own) => self.motion.set_ground_friction(node, own + torque),
            None => self.refused += 1,
        }
    }

    /// A rope has been wound up or paid out: stiffness, N m/rad, above zero, and damping, N m s/rad, zero or above, of
    /// a shaft change. Its elastic torque stays: the wound part keeps its stretch on the drum. Bad input changes
    /// nothing and counts as [`refused`](Self::refused).
    pub fn set_shaft(&mut self, shaft: usize, stiffness: f64, damping: f64) {
        let is_right = stiffness > 0.0 && stiffness.is_finite() && damping >= 0.0 && damping.is_finite();
        if is_right && shaft < self.motion.links() {
            self.motion.set_link(shaft, stiffness, damping);
        } else {
            self.refused += 1;
        }
    }

    /// Calls with bad input that were ignored.
    #[must_use]
    pub fn refused(&self) -> u64 {
        self.refused + self.motion.refused()
    }

    /// Angle of the motor, rad, unwrapped, zero at the start.
    #[must_use]
    pub fn motor_angle(&self) -> f64 {
        self.motion.angle(0)
    }

    /// Speed of the motor, rad/s.
    #[must_use]
    pub fn motor_speed(&self) -> f64 {
        self.motion.speed(0)
    }

    /// Twist of a shaft, rad: angle of its front node less that of its back node; NaN for a shaft that is not there.
    #[must_use]
    pub fn twist(&self, shaft: usize) -> f64 {
        self.motion.elongation(shaft)
    }

    /// Torque of a shaft, N m, referred to the motor, as felt by the node in front of it (a gear's loss included),
    /// positive when the motor drives the load; NaN for a shaft that is not there. While a gear holds its node, what
    /// the gear takes of the push on the node.
    #[must_use]
    pub fn shaft_torque(&self, shaft: usize) -> f64 {
        let (train, mode) = (&self.motion.train, &self.motion.mode);
        let Some(link) = train.links.get(shaft) else { return f64::NAN };
        let behind = self.torque_behind_gear(shaft);
        match train.frictions.iter().position(|friction| friction.losses.contains(&shaft)) {
            Some(s) if mode.slip[s] == 0 => {
                let (one, other) = (behind * link.back_efficiency, behind / link.efficiency);
                // `clamp` panics where a run that overflowed has made the band NaN
                (self.motion.read(Signal::Friction(s)) + behind).max(one.min(other)).min(one.max(other))
            }
            _ => mode.loss(train, shaft) * behind,
        }
    }

    /// Torque of a shaft as [`Self::shaft_torque`], without the loss of a gear in front of it: that of its twist.
    #[must_use]
    pub fn torque_behind_gear(&self, shaft: usize) -> f64 {
        self.force(shaft)
    }

    /// Torque against the positive motion of a node from outside the chain, N m: load, load program, dry and viscous
    /// friction; NaN for a node that is not there. While the node is held, the friction that holds it.
    #[must_use]
    pub fn load_torque(&self, node: usize) -> f64 {
        let (train, mode) = (&self.motion.train, &self.motion.mode);
        let Some(coordinate) = train.coordinates.get(node) else { return f64::NAN };
        let program =
            |source: &Source| if let Source::Program(program) = source { -program.at(self.time()).0 } else { 0.0 };
        let programs = coordinate.sources.iter().map(program).sum::<f64>();
        let dry = match train.frictions.iter().position(|friction| friction.terms[0].0 == node) {
            None => 0.0,
            Some(s) if mode.slip[s] != 0 => f64::from(mode.slip[s]) * train.frictions[s].kinetic,
            Some(s) if train.frictions[s].losses.is_empty() => self.motion.read(Signal::Friction(s)),
            Some(s) => {
                let held = self.motion.read(Signal::Friction(s)) + self.torque_behind_gear(node);
                let most = train.frictions[s].breakaway;
                (held - self.shaft_torque(node)).max(-most).min(most)
            }
        };
        self.loads[node] + programs + dry + coordinate.viscous * self.speed(node)
    }

    /// Number of inertias.
    #[must_use]
    pub fn nodes(&self) -> usize {
        self.loads.len()
    }

    /// Kinetic and strain energy, J.
    #[must_use]
    pub fn energy(&self) -> f64 {
        let kinetic: f64 = (0..self.nodes()).map(|j| self.inertia(j) * self.speed(j).powi(2)).sum();
        let strain = |(s, link): (usize, &Link)| {
            let stretch = self.twist(s) - link.origin(self.motion.mode.contact[s]);
            if self.motion.mode.carries(&self.motion.train, s) { link.stiffness * stretch.powi(2) } else { 0.0 }
        };
        0.5 * (kinetic + self.motion.train.links.iter().enumerate().map(strain).sum::<f64>())
    }

    /// Angular momentum about the motor shaft, N m s.
    #[must_use]
    pub fn momentum(&self) -> f64 {
        (0..self.nodes()).map(|j| self.inertia(j) * self.speed(j)).sum()
    }
}
