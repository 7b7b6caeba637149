//! Readings of a plant.

use super::event::Event;
use super::solver::Plant;

impl Plant {
    /// Time since the start, s.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.clock.0
    }

    /// Angle of the motor, rad, unwrapped, zero at the start.
    #[must_use]
    pub fn motor_angle(&self) -> f64 {
        self.x[self.layout.angle()]
    }

    /// Speed of the motor, rad/s.
    #[must_use]
    pub fn motor_speed(&self) -> f64 {
        self.x[self.layout.speed(0)]
    }

    /// Speed of a node, rad/s; NaN for a node that is not there.
    #[must_use]
    pub fn speed(&self, node: usize) -> f64 {
        if node < self.layout.nodes { self.x[self.layout.speed(node)] } else { f64::NAN }
    }

    /// Angle of a node, rad, unwrapped; NaN for a node that is not there.
    #[must_use]
    pub fn angle(&self, node: usize) -> f64 {
        if node < self.layout.nodes { self.motor_angle() - self.x[..node].iter().sum::<f64>() } else { f64::NAN }
    }

    /// Twist of a shaft, rad: angle of its front node less that of its back node; NaN for a shaft that is not there.
    #[must_use]
    pub fn twist(&self, shaft: usize) -> f64 {
        if shaft + 1 < self.layout.nodes { self.x[shaft] } else { f64::NAN }
    }

    /// Torque of a shaft, N m, referred to the motor, as felt by the node in front of it (a gear's loss included),
    /// positive when the motor drives the load; NaN for a shaft that is not there. While a gear holds its node, what
    /// the gear takes of the push on the node.
    #[must_use]
    pub fn shaft_torque(&self, shaft: usize) -> f64 {
        if shaft >= self.chain.shafts.len() {
            return f64::NAN;
        }
        if self.mode.is_held(shaft) && self.chain.nodes[shaft].is_lossy() {
            return self.hold(shaft).gear_torque();
        }
        self.mode.loss(&self.chain, shaft) * self.elastic(shaft)
    }

    /// Torque of a shaft as [`Self::shaft_torque`], without the loss of a gear in front of it: that of its twist.
    #[must_use]
    pub fn torque_behind_gear(&self, shaft: usize) -> f64 {
        let Some(link) = self.chain.shafts.get(shaft) else {
            return f64::NAN;
        };
        if !self.mode.carries(&self.chain, shaft) {
            return 0.0;
        }
        let stretch = self.x[shaft] - link.origin(self.mode.contact[shaft]);
        link.stiffness * stretch + link.damping * (self.speed(shaft) - self.speed(shaft + 1))
    }

    /// Torque against the positive motion of a node from outside the chain, N m: load, load program, dry and viscous
    /// friction; NaN for a node that is not there. While the node is held, the friction that holds it.
    #[must_use]
    pub fn load_torque(&self, node: usize) -> f64 {
        let Some(description) = self.chain.nodes.get(node) else {
            return f64::NAN;
        };
        let program = description.program.as_ref().map_or(0.0, |p| p.at(self.clock.0).0);
        let dry = match self.mode.motion[node] {
            0 => self.hold(node).friction(),
            direction if direction.abs() == 1 => f64::from(direction) * self.coulomb[node],
            _ => 0.0,
        };
        description.load + program + dry + description.viscous * self.speed(node)
    }

    /// Every event so far, in order of time.
    #[must_use]
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// Forgets the events so far, for long runs.
    pub fn clear_events(&mut self) {
        self.events.clear();
    }

    /// Number of inertias.
    #[must_use]
    pub fn nodes(&self) -> usize {
        self.layout.nodes
    }

    /// Inertia of a node, kg m2; NaN for a node that is not there.
    #[must_use]
    pub fn inertia(&self, node: usize) -> f64 {
        self.chain.nodes.get(node).map_or(f64::NAN, |node| node.inertia)
    }

    /// Whether a shaft carries nothing now: a gap is open, or a rope slack.
    #[must_use]
    pub fn is_open(&self) -> bool {
        (0..self.chain.shafts.len()).any(|shaft| !self.mode.carries(&self.chain, shaft))
    }

    /// Whether a shaft has backlash. A rope has none.
    #[must_use]
    pub fn has_backlash(&self) -> bool {
        self.chain.shafts.iter().any(|shaft| !shaft.rope && shaft.gap > 0.0)
    }

    /// Kinetic and strain energy, J.
    #[must_use]
    pub fn energy(&self) -> f64 {
        let nodes = self.chain.nodes.iter().enumerate();
        let kinetic: f64 = nodes.map(|(j, node)| node.inertia * self.speed(j).powi(2)).sum();
        let strain = self.chain.shafts.iter().enumerate().map(|(s, shaft)| {
            let carries = self.mode.carries(&self.chain, s);
            let stretch = self.x[s] - shaft.origin(self.mode.contact[s]);
            if carries { shaft.stiffness * stretch.powi(2) } else { 0.0 }
        });
        0.5 * (kinetic + strain.sum::<f64>())
    }

    /// Angular momentum about the motor shaft, N m s.
    #[must_use]
    pub fn momentum(&self) -> f64 {
        let nodes = self.chain.nodes.iter().enumerate();
        nodes.map(|(j, node)| node.inertia * self.speed(j)).sum()
    }
}
