//! The chain once more, written for an ordinary integrator: torques from the laws as they stand in the books.

use super::super::chain::Chain;
use super::super::excitation::MotorLaw;
use super::super::solver::Plant;
use super::pass::Hybrid;

/// How a node stands to its dry friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Motion {
    Smooth,
    Sliding(f64),
    Held,
}

/// Meaning of a guard that falls below zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Change {
    Contact(usize, f64),
    Flow(usize),
    Rest(usize),
    Loose(usize, f64),
}

/// Times its side: a contact that is closed, but whose damper takes all of its torque.
const TRAILING: f64 = 0.5;

/// Parameters and discrete state. The continuous state is twists, speeds, angle of the motor.
pub(super) struct Machine {
    pub chain: Chain,
    pub load: Vec<f64>,
    pub dry: Vec<f64>,
    pub motor_torque: f64,
    /// Side on which each shaft is in contact, 0 in the gap, or a side times [`TRAILING`].
    pub side: Vec<f64>,
    /// Sign of the torque of each shaft, for the gear in front of it.
    pub flow: Vec<f64>,
    pub motion: Vec<Motion>,
}

impl Machine {
    pub fn new(plant: &Plant, y: &[f64]) -> Self {
        let chain = &plant.chain;
        let side = chain.shafts.iter().zip(y).map(|(shaft, &twist)| {
            let reach = if shaft.rope { shaft.gap } else { 0.5 * shaft.gap };
            if shaft.is_linear() || twist > reach {
                1.0
            } else if twist < -reach && !shaft.rope {
                -1.0
            } else {
                0.0
            }
        });
        let mut machine = Self {
            load: chain.nodes.iter().map(|node| node.load).collect(),
            dry: chain.nodes.iter().zip(&plant.brakes).map(|(node, b)| node.coulomb + b).collect(),
            motor_torque: 0.0,
            side: side.collect(),
            flow: vec![1.0; chain.shafts.len()],
            motion: vec![Motion::Smooth; chain.nodes.len()],
            chain: chain.clone(),
        };
        for s in 0..chain.shafts.len() {
            let torque = machine.torque(y, s);
            machine.flow[s] = if torque < 0.0 { -1.0 } else { 1.0 };
            if !chain.shafts[s].is_linear() && torque * machine.side[s] < 0.0 {
                machine.side[s] *= TRAILING;
            }
        }
        machine
    }

    /// Winds a rope: its elastic torque stays, its twist beyond the slack changes with its stiffness.
    pub fn wind(&mut self, y: &mut [f64], s: usize, stiffness: f64, damping: f64) {
        let shaft = &mut self.chain.shafts[s];
        let slack = if shaft.rope { shaft.gap } else { 0.5 * shaft.gap * self.side[s].signum() };
        if self.side[s] != 0.0 {
            y[s] = slack + (y[s] - slack) * shaft.stiffness / stiffness;
        }
        (shaft.stiffness, shaft.damping) = (stiffness, damping);
    }

    fn n(&self) -> usize {
        self.chain.nodes.len()
    }

    pub fn speed(&self, y: &[f64], node: usize) -> f64 {
        y[self.n() - 1 + node]
    }

    /// Torque of the shaft itself.
    fn torque(&self, y: &[f64], s: usize) -> f64 {
        if self.side[s].abs() == 1.0 { self.strain(y, s) } else { 0.0 }
    }

    /// Torque of the shaft while it is in contact on its side, or on the positive side if it is not.
    fn strain(&self, y: &[f64], s: usize) -> f64 {
        let shaft = &self.chain.shafts[s];
        let reach = match shaft.gap {
            slack if shaft.rope => slack,
            backlash => 0.5 * backlash * self.side[s].signum(),
        };
        let closing = self.speed(y, s) - self.speed(y, s + 1);
        shaft.stiffness * (y[s] - reach) + shaft.damping * closing
    }

    fn motor(&self, t: f64, speed: f64) -> f64 {
        self.motor_torque
            + match self.chain.law {
                MotorLaw::Held => 0.0,
                MotorLaw::Constant(torque) => torque,
                MotorLaw::Ramp { torque, time } => (torque - torque * t / time) * f64::from(t < time),
                MotorLaw::Line { stall, slope } => stall - slope * speed,
            }
    }

    /// Torque on a node but for its dry friction and the shaft behind it.
    fn push(&self, t: f64, y: &[f64], node: usize) -> f64 {
        let speed = self.speed(y, node);
        let description = &self.chain.nodes[node];
        let program = description.program.as_ref().map_or(0.0, |program| program.at(t).0);
        let mut sum = -self.load[node] - program - description.viscous * speed;
        if node == 0 {
            sum += self.motor(t, speed);
        }
        if node > 0 {
            sum += self.torque(y, node - 1);
        }
        sum
    }

    /// Torque of the following shaft on a node.
    pub fn reaction(&self, t: f64, y: &[f64], node: usize) -> f64 {
        if node + 1 == self.n() {
            return 0.0;
        }
        let torque = self.torque(y, node);
        let gear = &self.chain.nodes[node];
        match self.motion[node] {
            Motion::Smooth => torque,
            Motion::Sliding(way) => {
                if self.flow[node] * way > 0.0 {
                    torque / gear.efficiency
                } else {
                    torque * gear.back_efficiency
                }
            }
            Motion::Held => {
                let (low, high) = self.band(y, node);
                self.push(t, y, node).clamp(low, high)
            }
        }
    }

    /// Torque that the gear of a sticking node can balance.
    fn band(&self, y: &[f64], node: usize) -> (f64, f64) {
        if node + 1 == self.n() {
            return (0.0, 0.0);
        }
        let torque = self.torque(y, node);
        let gear = &self.chain.nodes[node];
        let (one, other) = (torque * gear.back_efficiency, torque / gear.efficiency);
        (one.min(other), one.max(other))
    }

    /// Sets a node with dry friction or a lossy gear moving, or holds it.
    pub fn judge(&mut self, t: f64, y: &[f64], node: usize) {
        if self.dry[node] == 0.0 && !self.chain.nodes[node].is_lossy() {
            self.motion[node] = Motion::Smooth;
            return;
        }
        let speed = self.speed(y, node);
        let (low, high) = self.band(y, node);
        let push = self.push(t, y, node);
        self.motion[node] = if speed != 0.0 {
            Motion::Sliding(speed.signum())
        } else if push > high + self.dry[node] {
            Motion::Sliding(1.0)
        } else if push < low - self.dry[node] {
            Motion::Sliding(-1.0)
        } else {
            Motion::Held
        };
    }
}

impl Hybrid for Machine {
    type Change = Change;

    fn rate(&self, t: f64, y: &[f64], out: &mut [f64]) {
        let n = self.n();
        for (s, twist_rate) in out[..n - 1].iter_mut().enumerate() {
            *twist_rate = self.speed(y, s) - self.speed(y, s + 1);
        }
        for j in 0..n {
            let net = self.push(t, y, j);
            out[n - 1 + j] = match self.motion[j] {
                Motion::Held => 0.0,
                Motion::Smooth => net - self.reaction(t, y, j),
                Motion::Sliding(way) => net - self.reaction(t, y, j) - way * self.dry[j],
            } / self.chain.nodes[j].inertia;
        }
        out[2 * n - 1] = self.speed(y, 0);
    }

    fn guards(&self, t: f64, y: &[f64]) -> Vec<(f64, f64, Change)> {
        let mut all = Vec::new();
        for (s, shaft) in self.chain.shafts.iter().enumerate().filter(|(_, shaft)| !shaft.is_linear()) {
            let reach = if shaft.rope { shaft.gap } else { 0.5 * shaft.gap };
            let size = reach.max(y[s].abs());
            let (pull, side) = (shaft.stiffness * size, self.side[s].signum());
            if self.side[s].abs() == TRAILING {
                all.push((-side * self.strain(y, s), pull, Change::Contact(s, side)));
                all.push((side * y[s] - reach, size, Change::Contact(s, 0.0)));
                continue;
            }
            if self.side[s] != 0.0 {
                let left = if shaft.damping > 0.0 { side * TRAILING } else { 0.0 };
                all.push((side * self.strain(y, s), pull, Change::Contact(s, left)));
                continue;
            }
            all.push((reach - y[s], size, Change::Contact(s, 1.0)));
            if !shaft.rope {
                all.push((y[s] + reach, size, Change::Contact(s, -1.0)));
            }
        }
        for (s, shaft) in self.chain.shafts.iter().enumerate() {
            if self.chain.nodes[s].is_lossy() && shaft.is_linear() {
                let size = shaft.stiffness * y[s].abs();
                all.push((self.flow[s] * self.torque(y, s), size, Change::Flow(s)));
            }
        }
        let top = (0..self.n()).map(|j| self.speed(y, j).abs()).fold(0.0, f64::max);
        for j in 0..self.n() {
            match self.motion[j] {
                Motion::Smooth => {}
                Motion::Sliding(way) => all.push((way * self.speed(y, j), top, Change::Rest(j))),
                Motion::Held => {
                    let (push, (low, high)) = (self.push(t, y, j), self.band(y, j));
                    let size = push.abs().max(self.dry[j]);
                    all.push((high + self.dry[j] - push, size, Change::Loose(j, 1.0)));
                    all.push((push - low + self.dry[j], size, Change::Loose(j, -1.0)));
                }
            }
        }
        all
    }

    fn change(&mut self, t: f64, y: &mut [f64], change: Change) {
        match change {
            Change::Contact(shaft, side) => {
                self.side[shaft] = side;
                if side.abs() == 1.0 {
                    self.flow[shaft] = side;
                }
            }
            Change::Flow(shaft) => self.flow[shaft] = -self.flow[shaft],
            Change::Loose(node, way) => self.motion[node] = Motion::Sliding(way),
            Change::Rest(node) => {
                y[self.n() - 1 + node] = 0.0;
                self.judge(t, y, node);
            }
        }
    }
}
