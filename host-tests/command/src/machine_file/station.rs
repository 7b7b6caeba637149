//! Where the elements of a machine come to stand: their masses and shafts, and how fast they turn.

use driveline::machine::{Chain, Damper, Error, Inertia, Joint, Match, Modes, Ratio, Rigid, Shaft, Train, TwoMass};

use super::{Branch, DamperKind, DamperRing, Element, MachineFile, Part};

/// A chain of any number of masses, referred to its first. The library's own holds 16.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Line {
    pub masses: Vec<f64>,
    pub shafts: Vec<Shaft>,
    /// The last of it, which the next element follows.
    pub end: Chain,
}

impl Line {
    fn of(end: Chain) -> Self {
        Self { masses: end.masses().to_vec(), shafts: end.shafts().to_vec(), end }
    }

    /// Puts an element at its end.
    pub fn follow(&mut self, element: Element) -> Result<(), Error> {
        let first = self.masses.len() - self.end.masses().len();
        let longer = element.follow(self.end)?;
        self.masses.splice(first.., longer.masses().iter().copied());
        self.shafts.splice(first.., longer.shafts().iter().copied());
        self.end = longer.continued();
        Ok(())
    }
}

/// Where an element stands in its chain.
pub(crate) struct Station {
    /// The mass that it is, or is a part of.
    pub mass: Option<usize>,
    /// The shaft that it is, or is a part of.
    pub shaft: Option<usize>,
    /// The motor's speed, or the speed of what a branch stands on, over that of the element where it begins.
    pub ratio: f64,
    /// Index of the last mass up to and with the element.
    pub last: usize,
    /// Its inertia there (kg m2).
    pub inertia: f64,
}

/// First element of a branch that does not begin with a rotor: an inertia of zero.
pub(crate) const NOTHING: Inertia = Inertia(f64::MIN_POSITIVE);

/// The chain of a machine with its first element, or of a branch with its first.
pub(super) fn begun(element: Element) -> Result<Line, Error> {
    let begun = match element {
        Element::Rotor { inertia, viscous } => Element::Motor { inertia, viscous }.follow(Chain::motor(NOTHING)),
        element => element.follow(Chain::motor(NOTHING)),
    };
    begun.map(Line::of)
}

/// The elements as one chain; none of no elements.
pub(crate) fn line(elements: &[Part]) -> Option<Line> {
    let (first, rest) = elements.split_first()?;
    // the elements were read as a chain, so each of them can follow
    let mut line = begun(first.element).ok()?;
    rest.iter().try_for_each(|part| line.follow(part.element)).ok()?;
    Some(line)
}

/// Where the elements of a chain stand, in their order.
pub(crate) fn stations(elements: &[Part]) -> Vec<Station> {
    let mut stations: Vec<Station> = Vec::with_capacity(elements.len());
    let mut line: Option<Line> = None;
    for part in elements {
        let ratio = line.as_ref().map_or(1.0, |line| line.end.ratio());
        // the elements were read as a chain, so each of them can follow
        match &mut line {
            None => line = begun(part.element).ok(),
            Some(line) => _ = line.follow(part.element),
        }
        let Some(line) = &line else { continue };
        let last = line.masses.len() - 1;
        let (mass, shaft) = match part.element {
            Element::Motor { .. }
            | Element::Rotor { .. }
            | Element::Crank(_)
            | Element::Mechanism { .. }
            | Element::Planetary { .. }
            | Element::Lifted { .. }
            | Element::Driven { .. } => (Some(last), None),
            Element::Shaft { .. } | Element::Section { .. } | Element::Belt(_) | Element::Rope { .. } => {
                (None, last.checked_sub(1))
            }
            // a pendulum: its own spring and its own mass
            Element::Swinging { .. } => (Some(last), last.checked_sub(1)),
            Element::Gear { .. }
            | Element::Worm { .. }
            | Element::Drum { .. }
            | Element::Screw { .. }
            | Element::Slack { .. }
            | Element::Backlash { .. } => (None, None),
        };
        stations.push(Station { mass, shaft, ratio, last, inertia: line.masses[last] });
    }
    stations
}

/// A machine of more masses than the library's chains and trains hold, referred to the motor.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Long {
    masses: Vec<f64>,
    joints: Vec<Joint>,
    gravity_torque: f64,
}

impl Long {
    /// Of a chain and its branches.
    pub(super) fn of(elements: &[Part], branches: &[Branch]) -> Option<Self> {
        let main = line(elements)?;
        let between = |(from, &shaft): (usize, &Shaft)| Joint { from, to: from + 1, shaft };
        let mut long = Self {
            joints: main.shafts.iter().enumerate().map(between).collect(),
            gravity_torque: main.end.gravity_torque(),
            masses: main.masses,
        };
        for branch in branches {
            let own = line(&branch.elements)?;
            let square = branch.ratio * branch.ratio;
            long.masses[branch.node] += own.masses[0] / square;
            long.masses.extend(own.masses[1..].iter().map(|inertia| inertia / square));
            long.gravity_torque += own.end.gravity_torque() / branch.ratio;
            long.joints.extend(own.shafts.iter().enumerate().map(|(from, &shaft)| {
                let (stiffness, damping) = (shaft.stiffness / square, shaft.damping / square);
                let shaft = Shaft { stiffness, damping, gap: shaft.gap * branch.ratio, ..shaft };
                Joint { from: branch.mass(from), to: branch.mass(from + 1), shaft }
            }));
        }
        Some(long)
    }
}

impl Branch {
    /// The index in the whole machine of a mass of the branch.
    pub(crate) fn mass(&self, own: usize) -> usize {
        if own == 0 { self.node } else { self.first + own - 1 }
    }

    /// The index in the whole machine of a shaft of the branch.
    pub(crate) fn shaft(&self, own: usize) -> usize {
        self.first - 1 + own
    }
}

/// The machine as a whole, its branches included.
impl MachineFile {
    /// Inertias (kg m2) at the motor: the chain's, then those of the branches in their order.
    pub fn masses(&self) -> &[f64] {
        if let Some(long) = &self.long {
            return &long.masses;
        }
        self.train.as_ref().map_or(self.chain.masses(), |train| train.masses())
    }

    /// The shafts between them, in the same order.
    pub fn joints(&self) -> Vec<Joint> {
        if let Some(long) = &self.long {
            return long.joints.clone();
        }
        let between = |(from, &shaft): (usize, &Shaft)| Joint { from, to: from + 1, shaft };
        match &self.train {
            Some(train) => train.joints().to_vec(),
            None => self.chain.shafts().iter().enumerate().map(between).collect(),
        }
    }

    /// Natural vibrations.
    pub fn modes(&self) -> Modes {
        self.train.as_ref().map_or_else(|| self.chain.modes(), |train| train.modes())
    }

    /// Two masses for the machine.
    ///
    /// # Errors
    /// The library's sentence for a machine without an observable shaft, or an impossible cut.
    pub fn reduce(&self, by: Match) -> Result<TwoMass, Error> {
        self.train.as_ref().map_or_else(|| self.chain.try_reduce(by), |train| train.try_reduce(by))
    }

    /// The dampers with their sizes at the motor, as they come to stand on the train: a viscous ring takes its share of
    /// the mode that all other masses have, so after all others.
    pub(crate) fn rings(&self) -> Vec<(&DamperRing, Damper)> {
        let sized = self.sized_dampers().into_iter().map(|(ring, damper, _)| (ring, damper));
        let is_viscous = |(ring, _): &(&DamperRing, Damper)| matches!(ring.kind, DamperKind::Viscous { .. });
        let (viscous, mut rings): (Vec<_>, Vec<_>) = sized.partition(is_viscous);
        rings.extend(viscous);
        rings
    }

    /// The machine that a controller is designed for: with its dampers in its train, where it has any. A ring on dry
    /// friction sticks to its mass.
    ///
    /// # Errors
    /// The library's sentence for a ring that a train does not take, with its key.
    pub fn with_dampers(&self) -> Result<Self, String> {
        if self.dampers.is_empty() {
            return Ok(self.clone());
        }
        let mut train = self.train.unwrap_or_else(|| Train::of(self.chain));
        for (ring, damper) in self.rings() {
            train = match ring.kind {
                DamperKind::Friction { .. } => {
                    train.branch(ring.mass, Ratio(1.0), Chain::motor(Inertia(damper.inertia)))
                }
                _ => train.damper(ring.mass, Ratio(1.0), damper),
            };
            if let Some(error) = train.error() {
                let index = self.dampers.iter().take_while(|other| !std::ptr::eq(*other, ring)).count();
                return Err(format!("`damper[{index}]`: {error}"));
            }
        }
        Ok(Self { train: Some(train), dampers: Vec::new(), ..self.clone() })
    }

    /// One mass for the machine.
    pub fn rigid(&self) -> Result<Rigid, Error> {
        self.train.as_ref().map_or_else(|| self.chain.try_rigid(), |train| Ok(train.rigid()))
    }

    /// Torque of the weights at the motor (N m).
    pub fn gravity_torque(&self) -> f64 {
        if let Some(long) = &self.long {
            return long.gravity_torque;
        }
        self.train.as_ref().map_or(self.chain.gravity_torque(), |train| train.gravity_torque())
    }

    /// Viscous damping of each mass against the ground (N m s/rad), at the motor.
    pub fn viscous(&self) -> Vec<f64> {
        let mut all = vec![0.0; self.masses().len()];
        let mut add = |parts: &[Part], before: f64, at: &dyn Fn(usize) -> usize| {
            for (part, station) in parts.iter().zip(stations(parts)) {
                if let (Element::Motor { viscous, .. } | Element::Rotor { viscous, .. }, Some(mass)) =
                    (part.element, station.mass)
                {
                    all[at(mass)] += viscous / (before * station.ratio).powi(2);
                }
            }
        };
        add(&self.elements, 1.0, &|mass| mass);
        for branch in &self.branches {
            add(&branch.elements, branch.ratio, &|mass| branch.mass(mass));
        }
        all
    }

    /// Names of the masses and of the shafts between them, from the labels of the elements.
    pub(crate) fn names(&self) -> (Vec<String>, Vec<String>) {
        let (mut masses, mut shafts): (Vec<String>, Vec<String>) = (Vec::new(), Vec::new());
        let join = |names: &mut Vec<String>, index: usize, label: &str| {
            if names.len() <= index {
                names.resize(index + 1, String::new());
            }
            let name = &mut names[index];
            if !name.is_empty() {
                name.push_str(" + ");
            }
            name.push_str(label);
        };
        for (part, station) in self.elements.iter().zip(stations(&self.elements)) {
            station.shaft.inspect(|&shaft| join(&mut shafts, shaft, &part.label));
            station.mass.inspect(|&mass| join(&mut masses, mass, &part.label));
        }
        for branch in &self.branches {
            for (part, station) in branch.elements.iter().zip(stations(&branch.elements)) {
                station.shaft.inspect(|&shaft| join(&mut shafts, branch.shaft(shaft), &part.label));
                station.mass.inspect(|&mass| join(&mut masses, branch.mass(mass), &part.label));
            }
        }
        // between two shafts, or at the end of one, stands nothing but their own inertia
        masses.resize(self.masses().len(), String::new());
        for joint in self.joints() {
            if masses[joint.to].is_empty() {
                masses[joint.to] = format!("end of {}", shafts[joint.to - 1]);
            }
        }
        (masses, shafts)
    }
}
