//! The running train: state, mode, and its way through time.

use nalgebra::DMatrix;

use super::leap::Leap;
use super::pins::Pinning;
use super::rigid_gear::Flow;
use super::signal::Watch;
use super::state::{Mode, State};
use super::stretch::Stretch;
use super::{Coordinate, Friction, Link, Source, Train, Variation, coupling};
use crate::plant::error::PlantError;
use crate::plant::event::Event;
use crate::plant::vibration::{Network, Spring};

/// Product of the fastest rate and a stretch: `1.5^24/24!` = 3e-20 is left out.
const REACH: f64 = 1.5;
/// Default time within which an event is located: at most this, s, and this share of the fastest rate.
const EVENT_TOLERANCE: (f64, f64) = (1e-14, 1e-13);

/// A train in motion. Built by [`Train::build`]; a clone runs on independently.
#[derive(Debug, Clone)]
pub struct Motion {
    pub(super) train: Train,
    pub(super) state: State,
    pub(super) mode: Mode,
    /// Time at the last end of a tick, s, with what its rounding has lost.
    pub(super) clock: (f64, f64),
    /// Now, s.
    pub(super) now: f64,
    /// Torques held from outside.
    pub(super) held: Vec<f64>,
    /// Bound of the rates, 1/s.
    pub(super) rate: f64,
    /// As it was computed, with stiffness and damping of every link.
    computed: (f64, Vec<(f64, f64)>),
    pub(super) settled: bool,
    pub(super) event_tolerance: f64,
    pub(super) events: Vec<Event>,
    pub(super) watches: Vec<Watch>,
    /// Guards that fell, those that are not told as events included.
    pub(super) fired: u64,
    leap: Option<Box<Leap>>,
    refused: u64,
}

impl Train {
    /// Checks every number and readies the motion.
    ///
    /// # Errors
    /// [`PlantError`] names the first parameter that is out of range; a link is called a shaft, a coordinate a node.
    pub fn build(mut self) -> Result<Motion, PlantError> {
        self.validate()?;
        for (l, link) in self.links.iter().enumerate().filter(|(_, link)| link.is_lossy()) {
            let front = [(link.terms[0].0, 1.0)];
            let same = |friction: &&mut Friction| friction.terms == front && friction.surface == 0.0;
            match self.frictions.iter_mut().find(same) {
                Some(friction) => friction.losses.push(l),
                None => self.frictions.push(Friction { losses: vec![l], ..Friction::ground(front[0].0, 0.0) }),
            }
        }
        for at in (0..self.coordinates.len()).filter(|&at| self.coordinates[at].gear.is_some()) {
            if self.ground_friction(at).is_none() {
                self.frictions.push(Friction::ground(at, 0.0));
            }
        }
        Ok(Motion::new(self))
    }
}

impl Train {
    /// The friction of a coordinate against the ground.
    pub(super) fn ground_friction(&self, at: usize) -> Option<usize> {
        self.frictions.iter().position(|friction| friction.terms == [(at, 1.0)])
    }
}

impl Motion {
    pub(super) fn new(train: Train) -> Self {
        let state = State {
            elongation: train.links.iter().map(|link| link.elongation).collect(),
            speed: train.coordinates.iter().map(|c| c.speed).collect(),
            angle: train.coordinates.iter().map(|c| c.angle).collect(),
        };
        let teeth = teeth_of(&train);
        let contact = train.links.iter().enumerate().map(|(l, link)| {
            let edge = teeth.iter().find(|tooth| tooth.0 == l).map_or(0, |tooth| tooth.1);
            let error = |variation: &Variation| variation.over(link.stiffness, 0.0, 1.0, edge).1[0];
            let x = link.elongation - link.variation.as_ref().map_or(0.0, error);
            let (ahead, back) = (x > link.origin(1), x < -link.origin(1) && !link.rope);
            if link.is_linear() { 1 } else { i8::from(ahead) - i8::from(back) }
        });
        let mut arcs = Vec::new();
        for (j, coordinate) in train.coordinates.iter().enumerate() {
            for (s, source) in coordinate.sources.iter().enumerate() {
                if let Some((from, to, period)) = source.arc() {
                    let turn = (coordinate.angle / period).floor();
                    let within = coordinate.angle - turn * period;
                    // an arc through the angle zero began in the period before
                    let passed = i64::from(within >= from) + i64::from(within >= to) - i64::from(within < to - period);
                    arcs.push((j, s, 2 * turn as i64 + passed));
                } else if let Some(ends) = source.ends() {
                    arcs.push((j, s, ends.iter().filter(|end| coordinate.speed >= **end).count() as i64));
                }
            }
        }
        let mode = Mode {
            contact: contact.collect(),
            teeth: teeth.clone(),
            slip: vec![0; train.frictions.len()],
            flow: vec![1; train.links.len()],
            arcs,
            gears: gears_of(&train),
            pins: pins_of(&train),
            stuck: Vec::new(),
            holding: DMatrix::zeros(0, 0),
        };
        let rate = fastest(&train);
        let leap = Leap::of(&train);
        let links = train.links.iter().map(|link| (link.stiffness, link.damping));
        let mut motion = Self {
            computed: (rate, links.collect()),
            rate,
            held: vec![0.0; train.coordinates.len()],
            train,
            state,
            mode,
            clock: (0.0, 0.0),
            now: 0.0,
            settled: false,
            event_tolerance: EVENT_TOLERANCE.0.min(EVENT_TOLERANCE.1 / rate),
            events: Vec::new(),
            watches: Vec::new(),
            fired: 0,
            leap,
            refused: 0,
        };
        motion.trail();
        motion
    }

    /// Holds this torque (N m or N) on a coordinate from now on, beside its sources. One that is not finite, or on a
    /// coordinate that is not there, changes nothing and counts as [`refused`](Self::refused).
    pub fn set_torque(&mut self, coordinate: usize, torque: f64) {
        match self.held.get_mut(coordinate) {
            Some(held) if torque.is_finite() => *held = torque,
            _ => self.refused += 1,
        }
    }

    /// Gives a coordinate so much dry friction against the ground, N m or N, zero or above: a brake.
    pub(super) fn set_ground_friction(&mut self, at: usize, torque: f64) {
        let now = self.train.ground_friction(at).map_or(0.0, |s| self.train.frictions[s].kinetic);
        if torque == now {
            return;
        }
        match self.train.rub(at, torque) {
            (s, 1) => {
                let speed = self.state.speed[at];
                self.mode.slip.push(if speed == 0.0 { 0 } else { speed.signum() as i8 });
                self.mode.gather(&self.train);
                if speed == 0.0 && self.settled {
                    self.let_go(s);
                }
            }
            (s, -1) => {
                self.mode.slip.remove(s);
                self.mode.gather(&self.train);
            }
            _ => {}
        }
        self.leap = Leap::of(&self.train);
    }

    /// Gives a link another stiffness and damping, which are in their range; its elastic force stays.
    pub(super) fn set_link(&mut self, l: usize, stiffness: f64, damping: f64) {
        let (link, contact) = (&mut self.train.links[l], self.mode.contact[l]);
        if contact != 0 || link.is_linear() {
            let (origin, elongation) = (link.origin(contact), &mut self.state.elongation[l]);
            *elongation = origin + (*elongation - origin) * link.stiffness / stiffness;
        }
        (link.stiffness, link.damping) = (stiffness, damping);
        let (rate, computed) = &self.computed;
        let before = computed[l];
        let near = |now: f64, before: f64| now <= 2.0 * before && now >= 0.25 * before;
        if near(stiffness, before.0) && near(damping, before.1) {
            // no rate grows by more than the stiffness does under its root, and the damping
            let growth = (stiffness / before.0).sqrt().max(if damping > 0.0 { damping / before.1 } else { 0.0 });
            self.rate = self.rate.max(rate * growth);
        } else {
            self.compute_rate();
        }
        self.leap = Leap::of(&self.train);
    }

    fn compute_rate(&mut self) {
        self.rate = fastest(&self.train);
        let links = self.train.links.iter().map(|link| (link.stiffness, link.damping));
        self.computed = (self.rate, links.collect());
    }

    /// How many calls were refused.
    #[must_use]
    pub fn refused(&self) -> u64 {
        self.refused
    }

    /// Locates events within this time, s, above zero; 1e-14 s or a 1e-13th of the fastest swing if not said.
    pub fn set_event_tolerance(&mut self, tolerance: f64) {
        if tolerance > 0.0 {
            self.event_tolerance = tolerance;
        } else {
            self.refused += 1;
        }
    }

    /// Runs on by `dt` seconds, above zero.
    pub fn advance(&mut self, dt: f64) {
        if !(dt.is_finite() && dt > 0.0) {
            self.refused += 1;
            return;
        }
        if !self.settled {
            self.settled = true;
            self.settle();
        }
        let (clock, lost) = self.clock;
        let step = dt + lost;
        let end = clock + step;
        let mut corner = self.corner_after(self.now);
        if corner.is_some_and(|corner| corner < end) || !self.leap(dt, end) {
            while let Some(at) = corner.filter(|&corner| corner < end) {
                self.run_to(at);
                corner = self.corner_after(self.now);
            }
            self.run_to(end);
            if corner == Some(end) && self.train.links.iter().any(Link::jumps) {
                self.switch();
            }
            self.look_again();
        }
        // Neumaier's sum
        self.clock = (end, if clock >= step { (clock - end) + step } else { (step - end) + clock });
    }

    /// The mode may have changed but by a tick.
    pub(super) fn look_again(&mut self) {
        if let Some(leap) = &mut self.leap {
            leap.look_again();
        }
    }

    /// The same mode, with nothing held.
    pub(super) fn probe(&self) -> Self {
        let (train, state, mode) = (self.train.clone(), self.state.clone(), self.mode.clone());
        let held = vec![0.0; self.held.len()];
        Self {
            train,
            state,
            mode,
            held,
            events: Vec::new(),
            watches: Vec::new(),
            leap: None,
            computed: (0.0, Vec::new()),
            ..*self
        }
    }

    /// A whole tick at once, where no guard can fall in it.
    fn leap(&mut self, length: f64, end: f64) -> bool {
        if !self.watches.is_empty() {
            return false;
        }
        let Some(mut leap) = self.leap.take() else { return false };
        let leapt = leap.step(self, length);
        if leapt {
            let (elongation, moved) = leap.after.split_at(self.train.links.len());
            let (speed, angle) = moved.split_at(self.train.coordinates.len());
            self.state.elongation.copy_from_slice(elongation);
            self.state.speed.copy_from_slice(speed);
            self.state.angle.copy_from_slice(angle);
            self.now = end;
        }
        self.leap = Some(leap);
        leapt
    }

    pub(super) fn corner_after(&self, time: f64) -> Option<f64> {
        let sources = self.train.coordinates.iter().flat_map(|c| &c.sources).filter_map(|s| s.corner_after(time));
        let meshes = self.train.links.iter().filter_map(|link| link.variation.as_ref()?.corner_after(time));
        sources.chain(meshes).reduce(f64::min)
    }

    /// The stretch from here on.
    pub(super) fn stretch(&self, length: f64) -> Stretch {
        Stretch::new(&self.train, &self.mode, &self.state, &self.held, self.now, length)
    }

    /// The longest stretch worth trying.
    pub(super) fn longest(&self, left: f64) -> f64 {
        if self.rate * left > REACH { REACH / self.rate } else { left }
    }

    /// The angle, rad, of an end of an arc, even numbers begin it, odd ones end it; or the speed, rad/s, of the end of
    /// a piece.
    pub(super) fn arcs_end(&self, arc: usize, passed: i64) -> f64 {
        let (j, s, _) = self.mode.arcs[arc];
        let source = &self.train.coordinates[j].sources[s];
        if let Some(ends) = source.ends() {
            let beyond = if passed < 0 { f64::NEG_INFINITY } else { f64::INFINITY };
            return usize::try_from(passed).ok().and_then(|passed| ends.get(passed)).copied().unwrap_or(beyond);
        }
        let Some((from, to, period)) = source.arc() else { return f64::INFINITY };
        let within = if passed.rem_euclid(2) == 0 { from } else { to };
        passed.div_euclid(2) as f64 * period + within
    }
}

/// The edge ahead of every link whose teeth follow an angle, at the start.
pub(super) fn teeth_of(train: &Train) -> Vec<(usize, i64)> {
    let edge = |(l, link): (usize, &Link)| match &link.variation {
        Some(Variation::Teeth(teeth)) => Some((l, teeth.next_edge(train.coordinates[teeth.coordinate].angle))),
        _ => None,
    };
    train.links.iter().enumerate().filter_map(edge).collect()
}

/// The gears with no shaft behind them, as if they drove forwards.
pub(super) fn gears_of(train: &Train) -> Vec<Flow> {
    let geared = (0..train.coordinates.len()).filter(|&at| train.coordinates[at].gear.is_some());
    geared.filter_map(|at| Some(Flow { at, friction: train.ground_friction(at)?, sign: [1, 1] })).collect()
}

/// Where every crank with friction in its pins begins, as if its rod pulled; the first event says if it pushes.
pub(super) fn pins_of(train: &Train) -> Vec<Pinning> {
    let pinning = |(at, coordinate): (usize, &Coordinate)| {
        let passed = coordinate.pins.as_ref()?.passed(coordinate.angle);
        Some(Pinning { at, passed, pull: 1.0 })
    };
    train.coordinates.iter().enumerate().filter_map(pinning).collect()
}

/// Bound of the rates of a train, 1/s: the highest natural frequency with every link in contact at its stiffest, the
/// highest rate of damping, and how fast stiffnesses and torques swing.
pub(super) fn fastest(train: &Train) -> f64 {
    // of a gear the least that either direction feels, over the most that it makes of what is behind it
    let least = |c: &Coordinate| {
        c.gear.map_or(c.inertia, |gear| {
            let least = gear.back_efficiency.min(1.0 / gear.efficiency);
            (gear.front + least * (c.inertia - gear.front)) * gear.efficiency
        })
    };
    let (mut springs, mut dampers) = (Network::default(), Network::default());
    let mut swing = 0.0_f64;
    for (j, coordinate) in train.coordinates.iter().enumerate() {
        let slope: f64 = coordinate
            .sources
            .iter()
            .map(|source| if let Source::Line { slope, .. } = source { slope.abs() } else { 0.0 })
            .sum();
        springs.coordinate(least(coordinate), 0.0);
        dampers.coordinate(least(coordinate), 0.0);
        dampers.link(Spring::ground(j, coordinate.viscous + slope));
        swing = coordinate.sources.iter().map(Source::rate).fold(swing, f64::max);
    }
    for link in &train.links {
        let loss = (1.0 / link.efficiency).max(link.back_efficiency.abs());
        springs.link(Spring::new(&link.terms, loss * link.stiffest()));
        dampers.link(Spring::new(&link.terms, loss * link.damping));
        if let Some(variation) = &link.variation {
            swing = swing.max(variation.bounds(link.stiffness).1);
        }
    }
    let least = coupling::least(train).max(1e-3);
    springs.highest() / least.sqrt() + dampers.highest().powi(2) / least + swing
}
