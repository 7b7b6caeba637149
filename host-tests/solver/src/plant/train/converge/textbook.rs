//! The train once more, written for an ordinary integrator: forces and torques from the laws as they stand in the
//! books.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};

use super::super::pins::Pinning;
use super::super::rigid_gear::Flow;
use super::super::{Coordinate, Harmonic, Orders, Source, Train, Variation};
use super::Step;
use crate::plant::converge::pass::Hybrid;

/// Meaning of a guard that falls below zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Change {
    Side(usize, f64),
    Flow(usize),
    /// Torque behind a gear with no shaft, for one of both directions.
    Gear(usize, usize),
    Rest(usize),
    Loose(usize, f64),
    Arc(usize, i64),
    Pin(usize, i64),
    Rod(usize),
    Tooth(usize, i64),
}

/// Times its side: a contact that is closed, but whose damper takes all of its force.
const TRAILING: f64 = 0.5;

/// Share of the largest force that holds something within which another is rounding.
const ROUNDING: f64 = 1e-12;

/// Parameters and discrete state. The continuous state is elongations, speeds, angles.
#[derive(Clone)]
pub struct Double {
    train: Train,
    pub held: Vec<f64>,
    /// A time within the present interval between corners of the torques and stiffnesses, s.
    pub middle: f64,
    side: Vec<f64>,
    flow: Vec<f64>,
    /// Of each friction: the way it slides, 0 while it sticks.
    way: Vec<f64>,
    /// The frictions that stick, and their forces per torque over the root of the inertia of each coordinate.
    stuck: Vec<usize>,
    holding: DMatrix<f64>,
    gears: Vec<Flow>,
    arcs: Vec<(usize, usize, i64)>,
    pins: Vec<Pinning>,
    /// Links whose teeth follow an angle, and the edge ahead of each.
    teeth: Vec<(usize, i64)>,
    pub settled: bool,
    /// The highest order of what swings with the angle of each coordinate.
    orders: Vec<f64>,
    /// Peak speed of each coordinate in the run.
    peak: Vec<f64>,
    /// Whether the discrete state is another one than when this was last cleared.
    pub changed: bool,
}

impl Double {
    pub fn new(train: Train, held: Vec<f64>, arcs: &[(usize, usize, i64)], peak: &[f64]) -> Self {
        let side = train.links.iter().map(|link| {
            // contacts close where they are settled
            f64::from(u8::from(link.is_linear()))
        });
        Self {
            side: side.collect(),
            flow: vec![1.0; train.links.len()],
            way: vec![0.0; train.frictions.len()],
            stuck: Vec::new(),
            holding: DMatrix::zeros(0, 0),
            arcs: arcs.to_vec(),
            gears: super::super::motion::gears_of(&train),
            pins: super::super::motion::pins_of(&train),
            teeth: super::super::motion::teeth_of(&train),
            orders: train.coordinates.iter().map(highest_order).collect(),
            held,
            settled: false,
            peak: peak.to_vec(),
            changed: true,
            middle: 0.0,
            train,
        }
    }

    /// Does what is no tick; a bound of the rates afterwards, 1/s, of a link that has changed.
    pub fn apply(&mut self, step: Step, t: f64, y: &mut [f64]) -> f64 {
        self.changed = true;
        match step {
            Step::Advance(_) => {}
            Step::Torque(coordinate, torque) => self.held[coordinate] = torque,
            Step::Friction(at, torque) => match self.train.rub(at, torque) {
                (s, 1) => {
                    let over = self.speed(y, at);
                    self.way.push(if over == 0.0 { 0.0 } else { over.signum() });
                    self.hold();
                    if over == 0.0 && self.settled {
                        self.judge(t, y, s);
                    }
                }
                (s, -1) => {
                    self.way.remove(s);
                    self.hold();
                }
                _ => {}
            },
            Step::Link(l, stiffness, damping) => {
                let link = &mut self.train.links[l];
                let origin = if link.rope { link.gap } else { 0.5 * link.gap * self.side[l].signum() };
                if self.side[l] != 0.0 {
                    y[l] = origin + (y[l] - origin) * link.stiffness / stiffness;
                }
                (link.stiffness, link.damping) = (stiffness, damping);
                return super::super::motion::fastest(&self.train);
            }
        }
        0.0
    }

    /// Directions of the frictions and flows at the start.
    pub fn settle(&mut self, t: f64, y: &[f64]) {
        (self.settled, self.changed) = (true, true);
        for (l, link) in self.train.links.iter().enumerate() {
            let x = y[l] - self.law(t, l).1;
            if !link.is_linear() {
                let reach = if link.rope { link.gap } else { 0.5 * link.gap };
                let back = x < -reach && !link.rope;
                self.side[l] = f64::from(i8::from(x > reach) - i8::from(back));
            }
            let strain = self.strain(t, y, l);
            self.flow[l] = if strain * link.terms[0].1 < 0.0 { -1.0 } else { 1.0 };
            if !link.is_linear() && strain * self.side[l] < 0.0 {
                self.side[l] *= TRAILING;
            }
        }
        for s in 0..self.way.len() {
            let over = self.over(y, s);
            self.way[s] = if over == 0.0 { 0.0 } else { over.signum() };
        }
        self.hold();
        self.face_gears(t, y);
        for s in 0..self.way.len() {
            if self.way[s] == 0.0 {
                self.judge(t, y, s);
            }
        }
    }

    fn speed(&self, y: &[f64], j: usize) -> f64 {
        y[self.train.links.len() + j]
    }

    fn angle(&self, y: &[f64], j: usize) -> f64 {
        y[self.train.links.len() + self.train.coordinates.len() + j]
    }

    /// Stiffness and error of a link, and the rate of the error.
    fn law(&self, t: f64, l: usize) -> (f64, f64, f64) {
        let link = &self.train.links[l];
        match &link.variation {
            None => (link.stiffness, 0.0, 0.0),
            Some(Variation::Zones(zones)) => {
                let cycle: f64 = zones.iter().map(|zone| zone.duration).sum();
                let mut left = self.middle.rem_euclid(cycle);
                for zone in zones {
                    if left < zone.duration {
                        return (zone.stiffness, zone.error_force / zone.stiffness, 0.0);
                    }
                    left -= zone.duration;
                }
                (zones[0].stiffness, zones[0].error_force / zones[0].stiffness, 0.0)
            }
            Some(Variation::Teeth(teeth)) => {
                // the middle of the zone says how many pairs share the load
                let ahead = self.teeth.iter().find(|tooth| tooth.0 == l).map_or(0, |tooth| tooth.1);
                let pitches = 0.5 * (teeth.edge(ahead - 1) + teeth.edge(ahead)) * teeth.count / TAU;
                let first = pitches.floor().rem_euclid(2.0) == 0.0;
                let [this, last] = if first { teeth.errors } else { [teeth.errors[1], teeth.errors[0]] };
                if pitches - pitches.floor() < teeth.contact_ratio - 1.0 {
                    let force = (teeth.double - teeth.leaving) * this + teeth.leaving * last;
                    (teeth.double, force / teeth.double, 0.0)
                } else {
                    (teeth.single, this, 0.0)
                }
            }
            Some(Variation::Harmonics { frequency, stiffness, error }) => {
                let turn = |h: &super::super::Harmonic| {
                    let phase = TAU * frequency * h.order * t;
                    h.cosine * phase.cos() + h.sine * phase.sin()
                };
                let rate = |h: &super::super::Harmonic| {
                    let omega = TAU * frequency * h.order;
                    omega * (h.sine * (omega * t).cos() - h.cosine * (omega * t).sin())
                };
                let stiffness = link.stiffness + stiffness.iter().map(turn).sum::<f64>();
                (stiffness, error.iter().map(turn).sum(), error.iter().map(rate).sum())
            }
        }
    }

    /// Force of a link as if it were in contact, on the positive side if it is on none.
    fn strain(&self, t: f64, y: &[f64], l: usize) -> f64 {
        let link = &self.train.links[l];
        let reach = if link.rope { link.gap } else { 0.5 * link.gap * self.side[l].signum() };
        let (k, error, opening) = self.law(t, l);
        let rate: f64 = link.terms.iter().map(|&(at, c)| c * self.speed(y, at)).sum();
        k * (y[l] - reach - error) + link.damping * (rate - opening)
    }

    /// Force that the link carries.
    pub fn carried(&self, t: f64, y: &[f64], l: usize) -> f64 {
        if self.side[l].abs() == 1.0 { self.strain(t, y, l) } else { 0.0 }
    }

    fn torque(&self, t: f64, y: &[f64], j: usize, s: usize, source: &Source) -> f64 {
        let (speed, angle) = (self.speed(y, j), self.angle(y, j));
        match source {
            Source::Constant(torque) => *torque,
            Source::Program(program) => {
                let (torque, rate) = program.at(self.middle);
                torque + rate * (t - self.middle)
            }
            Source::Starting { torque, time, power } => {
                if self.middle < *time {
                    torque * (1.0 - (t / time).powi(i32::from(*power)))
                } else {
                    0.0
                }
            }
            Source::Waveform(wave) => wave.at(t),
            Source::Line { stall, slope } => stall - slope * speed,
            Source::Parabola(a, b, c) => a + speed * (b + c * speed),
            Source::Kloss { breakdown, slip, synchronous } => {
                let at = 1.0 - speed / synchronous;
                if at == 0.0 { 0.0 } else { 2.0 * breakdown / (at / slip + slip / at) }
            }
            Source::Series { voltage, resistance, flux } => {
                let current = voltage / (resistance + flux * speed);
                flux * current * current
            }
            Source::Pieces { torques, .. } => {
                let passed = self.arcs.iter().find(|arc| (arc.0, arc.1) == (j, s)).map_or(0, |arc| arc.2);
                match passed.checked_sub(1).and_then(|piece| torques.get(piece as usize)) {
                    Some([a, b, c]) if passed > 0 => a + speed * (b + c * speed),
                    _ => 0.0,
                }
            }
            Source::Arc { torque, .. } => {
                if self.on_arc(j, s) {
                    *torque
                } else {
                    0.0
                }
            }
            Source::Stroke { torque, .. } => {
                if self.on_arc(j, s) {
                    series(torque, angle)[0]
                } else {
                    0.0
                }
            }
            Source::Orders(orders) => {
                let turn = |h: &super::super::Harmonic| {
                    let phase = h.order * angle;
                    h.cosine * phase.cos() + h.sine * phase.sin()
                };
                orders.iter().map(turn).sum()
            }
        }
    }

    /// Of a crank with friction in its pins: the force on its slider, the torque that the pins take of a force of 1 N
    /// in the rod along the slider's way, first and second derivative of that way by the angle, and the slider's mass.
    /// Powers over the speed of the crank, pin by pin, from the angle of the rod. Of a four-bar those of the torque on
    /// its rocker.
    fn pinned(&self, y: &[f64], pinning: &Pinning) -> [f64; 5] {
        let coordinate = &self.train.coordinates[pinning.at];
        let Some(pinned) = &coordinate.pins else { return [0.0; 5] };
        let (force, [sense, second]) = pinned.piece(pinning.passed);
        let angle = self.angle(y, pinning.at);
        if let (Some(crank), Some(pins)) = (coordinate.crank, pinned.of_crank()) {
            let (sine, cosine) = angle.sin_cos();
            let (r, l) = (crank.radius, crank.rod);
            let lean = (r * sine / l).asin();
            let rate = r * cosine / (l * lean.cos());
            let bend = (l * lean.sin() * rate * rate - r * sine) / (l * lean.cos());
            // frame and crank at 1 rad/s, crank and rod at 1 + rate, rod and slider at the rate
            let slip = pins.main + pins.crank * (1.0 + rate) + pins.wrist * sense * rate;
            let way = -r * sine - l * lean.sin() * rate;
            let turned = -r * cosine - l * (lean.cos() * rate * rate + lean.sin() * bend);
            return [force, pins.coefficient / lean.cos() * slip, way, turned, crank.slider_mass];
        }
        let Some((pins, bars, inertia)) = pinned.of_four_bar() else { return [0.0; 5] };
        let [theta, psi] = bars.angles(angle);
        let arm = bars.rocker * (psi - theta).sin();
        // both pins of the coupler move alike along it; that at the rocker does not move along the rocker
        let rocker = bars.crank * (angle - theta).sin() / arm;
        let coupler = bars.rocker * bars.crank * (angle - psi).sin() / (bars.coupler * arm);
        let along = bars.crank * (angle - theta).cos() + bars.coupler * coupler * coupler;
        let turned = (along - bars.rocker * rocker * rocker * (psi - theta).cos()) / arm;
        let slip = pins.main
            + pins.crank * (1.0 - coupler)
            + pins.rocker * sense * (coupler - rocker)
            + pins.pivot * second * rocker;
        [force, pins.coefficient * slip / arm.abs(), rocker, turned, inertia]
    }

    fn on_arc(&self, j: usize, s: usize) -> bool {
        self.arcs.iter().any(|arc| arc.0 == j && arc.1 == s && arc.2.rem_euclid(2) == 1)
    }

    fn over(&self, y: &[f64], s: usize) -> f64 {
        let friction = &self.train.frictions[s];
        friction.terms.iter().map(|&(at, c)| c * self.speed(y, at)).sum::<f64>() - friction.surface
    }

    fn loss(&self, l: usize) -> f64 {
        let (eta, back) = (self.train.links[l].efficiency, self.train.links[l].back_efficiency);
        if !self.train.links[l].is_lossy() {
            return 1.0;
        }
        let gear = self.train.frictions.iter().position(|friction| friction.losses.contains(&l));
        let power = gear.map_or(0.0, |s| self.way[s]) * self.flow[l];
        if power == 0.0 {
            1.0
        } else if power > 0.0 {
            1.0 / eta
        } else {
            back
        }
    }

    /// Gathers what sticks: its accelerations must vanish, by the least of forces; rows scaled by the root of inertia.
    fn hold(&mut self) {
        self.stuck = (0..self.way.len()).filter(|&s| self.way[s] == 0.0).collect();
        if self.stuck.is_empty() {
            return;
        }
        let root = |j: usize| self.train.coordinates[j].inertia.sqrt();
        let rows = DMatrix::from_fn(self.train.coordinates.len(), self.stuck.len(), |j, column| {
            let terms = &self.train.frictions[self.stuck[column]].terms;
            terms.iter().find(|term| term.0 == j).map_or(0.0, |term| term.1 / root(j))
        });
        let touched: Vec<bool> = rows.row_iter().map(|row| row.iter().any(|share| *share != 0.0)).collect();
        let svd = rows.svd(true, true);
        let size = svd.singular_values.max();
        self.holding = svd.pseudo_inverse(1e-9 * size).unwrap_or_else(|_| DMatrix::zeros(0, 0));
        // what drives the others may be large beside a force that is nothing, and is not to enter by a rounding
        for (j, _) in touched.iter().enumerate().filter(|(_, touched)| !**touched) {
            self.holding.column_mut(j).fill(0.0);
        }
    }

    /// Torques on the coordinates but for the frictions that stick, and the forces of those.
    fn balance(&self, t: f64, y: &[f64], net: &mut [f64]) -> Vec<f64> {
        let train = &self.train;
        for (j, coordinate) in train.coordinates.iter().enumerate() {
            let sources = coordinate.sources.iter().enumerate();
            let torque: f64 = sources.map(|(s, source)| self.torque(t, y, j, s, source)).sum();
            net[j] = self.held[j] + torque - coordinate.viscous * self.speed(y, j);
        }
        for pinning in &self.pins {
            let [force, loss, ..] = self.pinned(y, pinning);
            net[pinning.at] -= pinning.pull * loss * force;
        }
        for (l, link) in train.links.iter().enumerate() {
            let force = self.carried(t, y, l);
            for (i, &(at, c)) in link.terms.iter().enumerate() {
                net[at] -= c * force * if i == 0 { self.loss(l) } else { 1.0 };
            }
        }
        for (friction, way) in train.frictions.iter().zip(&self.way) {
            for &(at, c) in &friction.terms {
                net[at] -= c * way * friction.kinetic;
            }
        }
        for g in 0..self.gears.len() {
            let [front, behind] = self.geared(t, y, g);
            let factor = if self.way[self.gears[g].friction] == 0.0 { 1.0 } else { self.gear_loss(g) };
            net[self.gears[g].at] = front + factor * behind;
        }
        let mut forces = vec![0.0; self.way.len()];
        for (row, &s) in self.stuck.iter().enumerate() {
            let push = |(j, net): (usize, &f64)| -net / train.coordinates[j].inertia.sqrt() * self.holding[(row, j)];
            forces[s] = net.iter().enumerate().map(push).sum();
        }
        forces
    }

    /// Torques in front of a gear and behind it, dry friction included while it slides.
    fn geared(&self, t: f64, y: &[f64], g: usize) -> [f64; 2] {
        let Flow { at, friction, .. } = self.gears[g];
        let coordinate = &self.train.coordinates[at];
        let sources = coordinate.sources.iter().enumerate();
        let driven: f64 = sources.map(|(s, source)| self.torque(t, y, at, s, source)).sum();
        let dry = self.way[friction] * self.train.frictions[friction].kinetic;
        let mut both = [0.0, self.held[at] + driven - coordinate.viscous * self.speed(y, at) - dry];
        for (l, link) in self.train.links.iter().enumerate() {
            for (i, &(_, c)) in link.terms.iter().enumerate().filter(|(_, term)| term.0 == at) {
                both[usize::from(i == 0)] -= c * self.carried(t, y, l);
            }
        }
        both
    }

    /// Loss of a gear while it slides, or is to slide towards the direction of its friction.
    fn gear_loss(&self, g: usize) -> f64 {
        let flow = &self.gears[g];
        let way = if self.way[flow.friction] < 0.0 { -1 } else { 1 };
        self.train.coordinates[flow.at].gear.map_or(1.0, |gear| flow.factor(&gear, way))
    }

    /// Torque through a gear, if it slides or is about to slide in the first or second direction.
    fn through(&self, t: f64, y: &[f64], g: usize, direction: usize) -> f64 {
        let Flow { at, friction, .. } = self.gears[g];
        let [front, behind] = self.geared(t, y, g);
        if self.way[friction] == 0.0 {
            let dry = self.train.frictions[friction].breakaway;
            return if direction == 0 { dry - behind } else { -dry - behind };
        }
        let coordinate = &self.train.coordinates[at];
        let (loss, before) = (self.gear_loss(g), coordinate.gear.map_or(0.0, |gear| gear.front));
        let after = coordinate.inertia - before;
        (after * front + before * -behind) / (before + loss * after)
    }

    fn face_gears(&mut self, t: f64, y: &[f64]) {
        for g in 0..self.gears.len() {
            self.gears[g].sign = [0, 1].map(|direction| if self.through(t, y, g, direction) < 0.0 { -1 } else { 1 });
        }
    }

    /// How far a friction that sticks is from slipping to each side.
    fn margin(&self, t: f64, y: &[f64], s: usize, force: f64, side: f64) -> f64 {
        let friction = &self.train.frictions[s];
        if let Some(g) = self.gears.iter().position(|flow| flow.friction == s) {
            let gear = self.train.coordinates[self.gears[g].at].gear;
            let loss = gear.map_or(1.0, |gear| self.gears[g].factor(&gear, side as i8));
            return side * (loss * self.through(t, y, g, usize::from(side < 0.0)) - self.geared(t, y, g)[0]);
        }
        let mut room = friction.breakaway + side * force;
        for &l in &friction.losses {
            let (eta, back) = (self.train.links[l].efficiency, self.train.links[l].back_efficiency);
            let torque = self.carried(t, y, l) * self.train.links[l].terms[0].1;
            let factor = if side * self.flow[l] > 0.0 { 1.0 / eta } else { back };
            room += side * (factor - 1.0) * torque;
        }
        room
    }

    fn judge(&mut self, t: f64, y: &[f64], s: usize) {
        self.way[s] = 0.0;
        self.hold();
        self.face_gears(t, y);
        let forces = self.balance(t, y, &mut vec![0.0; self.train.coordinates.len()]);
        for side in [1.0, -1.0] {
            if self.margin(t, y, s, forces[s], side) < -ROUNDING * largest(&forces) {
                self.way[s] = side;
                self.hold();
                return;
            }
        }
    }

    /// Accelerations of the coordinates that unbalances couple, from Lagrange's equations as they stand.
    fn unbalanced(&self, y: &[f64], torques: &[f64], out: &mut [f64]) {
        let (links, n) = (self.train.links.len(), self.train.coordinates.len());
        let mut mass = DMatrix::from_fn(n, n, |i, j| if i == j { self.train.coordinates[i].inertia } else { 0.0 });
        let mut right = DVector::from_column_slice(torques);
        for unbalance in &self.train.unbalances {
            let (turning, way, moment) = (unbalance.turning, unbalance.way, unbalance.moment);
            let (sine, cosine) = self.angle(y, turning).sin_cos();
            mass[(turning, way)] -= moment * sine;
            mass[(way, turning)] -= moment * sine;
            right[turning] += moment * unbalance.gravity * sine;
            right[way] += moment * self.speed(y, turning).powi(2) * cosine;
        }
        let Some(solved) = mass.qr().solve(&right) else { return };
        for unbalance in &self.train.unbalances {
            for at in [unbalance.turning, unbalance.way] {
                out[links + at] = solved[at];
            }
        }
    }

    fn arc_end(&self, arc: usize, passed: i64) -> f64 {
        let (j, s, _) = self.arcs[arc];
        let (from, to, period) = match &self.train.coordinates[j].sources[s] {
            Source::Arc { from, to, .. } => (from, to, TAU),
            Source::Stroke { from, to, turns, .. } => (from, to, TAU * f64::from(*turns)),
            Source::Pieces { .. } if passed < 0 => return f64::NEG_INFINITY,
            Source::Pieces { ends, .. } => return ends.get(passed as usize).copied().unwrap_or(f64::INFINITY),
            _ => return f64::INFINITY,
        };
        period * passed.div_euclid(2) as f64 + if passed.rem_euclid(2) == 0 { *from } else { *to }
    }
}

/// The highest order at which torques swing with an angle. An order of a millionth of the largest turns nothing.
fn highest_order(coordinate: &Coordinate) -> f64 {
    let of_orders = |orders: &[Harmonic]| {
        let most = orders.iter().map(|h| h.cosine.hypot(h.sine)).fold(0.0, f64::max);
        let felt = orders.iter().filter(|h| h.cosine.hypot(h.sine) > 1e-6 * most);
        felt.map(|h| h.order.abs()).fold(0.0, f64::max)
    };
    let highest = |source: &Source| match source {
        Source::Orders(orders) | Source::Stroke { torque: Orders(orders), .. } => of_orders(orders),
        _ => 0.0,
    };
    // second and higher orders of the way of the slider or rocker load the pins
    let crank = coordinate.pins.as_ref().and(coordinate.crank);
    let rod = crank.map_or(0.0, |k| 2.0 / (1.0 - (k.radius / k.rod).powi(2)).sqrt());
    let pinned = coordinate.pins.iter().flat_map(|pinned| pinned.orders()).map(|orders| of_orders(&orders.0));
    coordinate.sources.iter().map(highest).chain(pinned).fold(rod, f64::max)
}

impl Hybrid for Double {
    type Change = Change;

    fn turning(&self, y: &[f64]) -> f64 {
        let rates = self.orders.iter().enumerate().map(|(j, order)| order * self.speed(y, j).abs());
        rates.fold(0.0, f64::max)
    }

    fn rate(&self, t: f64, y: &[f64], out: &mut [f64]) {
        let (links, n) = (self.train.links.len(), self.train.coordinates.len());
        for (l, link) in self.train.links.iter().enumerate() {
            out[l] = link.terms.iter().map(|&(at, c)| c * self.speed(y, at)).sum();
        }
        let net = &mut out[links..links + n];
        let forces = self.balance(t, y, net);
        for &s in &self.stuck {
            for &(at, c) in &self.train.frictions[s].terms {
                net[at] += c * forces[s];
            }
        }
        let torques = if self.train.unbalances.is_empty() { Vec::new() } else { net.to_vec() };
        for (j, coordinate) in self.train.coordinates.iter().enumerate() {
            let speed = self.speed(y, j);
            let angle = self.angle(y, j);
            let (mut inertia, mut slope) = coordinate.crank.map_or((0.0, 0.0), |crank| whole_inertia(&crank, angle));
            if let Some(law) = &coordinate.law {
                let [more, steeper] = series(law, angle);
                (inertia, slope) = (inertia + more, slope + steeper);
            }
            let mut push = 0.5 * slope * speed * speed;
            if let Some(pinning) = self.pins.iter().find(|pinning| pinning.at == j) {
                // the pins take a share of what speeds the slider or the rocker up
                let [_, loss, way, bend, mass] = self.pinned(y, pinning);
                let share = pinning.pull * loss * mass;
                (inertia, push) = (inertia - share * way, push - share * bend * speed * speed);
            }
            if let Some(g) = self.gears.iter().position(|flow| flow.at == j && self.way[flow.friction] != 0.0)
                && let Some(gear) = coordinate.gear
            {
                inertia += (self.gear_loss(g) - 1.0) * (coordinate.inertia - gear.front);
            }
            out[links + j] = (out[links + j] - push) / (coordinate.inertia + inertia);
            out[links + n + j] = speed;
        }
        if !torques.is_empty() {
            self.unbalanced(y, &torques, out);
        }
        for &s in &self.stuck {
            if let [(at, _)] = self.train.frictions[s].terms[..] {
                out[links + at] = 0.0;
            }
        }
    }

    fn guards(&self, t: f64, y: &[f64]) -> Vec<(f64, f64, Change)> {
        let mut all = Vec::new();
        for (l, link) in self.train.links.iter().enumerate() {
            let reach = if link.rope { link.gap } else { 0.5 * link.gap };
            let (stiffness, error, _) = self.law(t, l);
            let (x, size) = (y[l] - error, reach.max(y[l].abs()).max(error.abs()));
            let pull = stiffness * size;
            let strain = self.strain(t, y, l);
            if link.is_linear() {
                if link.is_lossy() {
                    all.push((self.flow[l] * strain * link.terms[0].1, pull, Change::Flow(l)));
                }
                continue;
            }
            let side = self.side[l].signum();
            if self.side[l].abs() == TRAILING {
                all.push((-side * strain, pull, Change::Side(l, side)));
                all.push((side * x - reach, size, Change::Side(l, 0.0)));
            } else if self.side[l] != 0.0 {
                let left = if link.damping > 0.0 { side * TRAILING } else { 0.0 };
                all.push((side * strain, pull, Change::Side(l, left)));
                if left != 0.0 && link.jumps() {
                    all.push((side * x - reach, size, Change::Side(l, 0.0)));
                }
            } else {
                all.push((reach - x, size, Change::Side(l, 1.0)));
                if !link.rope {
                    all.push((x + reach, size, Change::Side(l, -1.0)));
                }
            }
        }
        let forces = if self.stuck.is_empty() {
            Vec::new()
        } else {
            self.balance(t, y, &mut vec![0.0; self.train.coordinates.len()])
        };
        for (s, friction) in self.train.frictions.iter().enumerate() {
            let way = self.way[s];
            if way != 0.0 {
                // what others hold does not slide by a rounding
                let size = friction.terms.iter().map(|&(at, c)| (c * self.peak[at]).abs()).fold(0.0, f64::max);
                all.push((way * self.over(y, s), size.max(friction.surface.abs()), Change::Rest(s)));
                continue;
            }
            // solved for all that sticks: each has the rounding of the largest
            let size = largest(&forces).max(friction.breakaway);
            for side in [1.0, -1.0] {
                all.push((self.margin(t, y, s, forces[s], side), size, Change::Loose(s, side)));
            }
        }
        for (g, flow) in self.gears.iter().enumerate() {
            let [front, behind] = self.geared(t, y, g);
            let way = self.way[flow.friction];
            for direction in [0, 1] {
                if way == 0.0 || (way < 0.0) == (direction == 1) {
                    let torque = f64::from(flow.sign[direction]) * self.through(t, y, g, direction);
                    all.push((torque, front.abs() + behind.abs(), Change::Gear(g, direction)));
                }
            }
        }
        for (arc, &(j, s, passed)) in self.arcs.iter().enumerate() {
            let (ahead, behind) = (self.arc_end(arc, passed), self.arc_end(arc, passed - 1));
            let pieces = matches!(self.train.coordinates[j].sources[s], Source::Pieces { .. });
            let at = if pieces { self.speed(y, j) } else { self.angle(y, j) };
            if ahead.is_finite() {
                all.push((ahead - at, ahead.abs(), Change::Arc(arc, 1)));
            }
            if behind.is_finite() {
                all.push((at - behind, behind.abs(), Change::Arc(arc, -1)));
            }
        }
        let mut rates = vec![0.0; if self.pins.is_empty() { 0 } else { y.len() }];
        if !rates.is_empty() {
            self.rate(t, y, &mut rates);
        }
        for (i, pinning) in self.pins.iter().enumerate() {
            let Some(pinned) = &self.train.coordinates[pinning.at].pins else { continue };
            let [force, _, way, bend, mass] = self.pinned(y, pinning);
            let speeding = mass * way * rates[self.train.links.len() + pinning.at];
            let turning = mass * bend * self.speed(y, pinning.at).powi(2);
            let size = force.abs() + speeding.abs() + turning.abs();
            all.push((pinning.pull * (force - speeding - turning), size, Change::Rod(i)));
            let angle = self.angle(y, pinning.at);
            let (ahead, behind) = (pinned.end(pinning.passed), pinned.end(pinning.passed - 1));
            all.push((ahead - angle, ahead.abs(), Change::Pin(i, 1)));
            all.push((angle - behind, behind.abs(), Change::Pin(i, -1)));
        }
        for (i, &(l, edge)) in self.teeth.iter().enumerate() {
            if let Some(Variation::Teeth(teeth)) = &self.train.links[l].variation {
                let (angle, ahead, behind) = (self.angle(y, teeth.coordinate), teeth.edge(edge), teeth.edge(edge - 1));
                all.push((ahead - angle, ahead.abs(), Change::Tooth(i, 1)));
                all.push((angle - behind, behind.abs(), Change::Tooth(i, -1)));
            }
        }
        all
    }

    fn change(&mut self, t: f64, y: &mut [f64], change: Change) {
        self.changed = true;
        match change {
            Change::Side(l, side) => {
                self.side[l] = side;
                if side.abs() == 1.0 {
                    self.flow[l] = side * self.train.links[l].terms[0].1.signum();
                }
            }
            Change::Flow(l) => self.flow[l] = -self.flow[l],
            Change::Gear(g, direction) => self.gears[g].sign[direction] *= -1,
            Change::Loose(s, side) => {
                self.way[s] = side;
                self.hold();
            }
            Change::Rest(s) => {
                let friction = &self.train.frictions[s];
                if let [(at, _)] = friction.terms[..] {
                    y[self.train.links.len() + at] = friction.surface;
                }
                self.judge(t, y, s);
            }
            Change::Arc(arc, step) => self.arcs[arc].2 += step,
            Change::Pin(i, step) => self.pins[i].passed += step,
            Change::Rod(i) => self.pins[i].pull *= -1.0,
            Change::Tooth(i, step) => self.teeth[i].1 += step,
        }
    }
}

fn largest(forces: &[f64]) -> f64 {
    forces.iter().fold(0.0, |most, force| most.max(force.abs()))
}

/// Value and derivative of a series at an angle.
fn series(orders: &super::super::Orders, angle: f64) -> [f64; 2] {
    orders.0.iter().fold([0.0; 2], |[value, slope], h| {
        let (sine, cosine) = (h.order * angle).sin_cos();
        [value + h.cosine * cosine + h.sine * sine, slope + h.order * (h.sine * cosine - h.cosine * sine)]
    })
}

/// Inertia of slider and rod at an angle, and its derivative, from the squares of speeds written out `[Wang 1989
/// (1-15)]`.
fn whole_inertia(crank: &super::super::Crank, angle: f64) -> (f64, f64) {
    let (r, l, f) = (crank.radius, crank.rod, crank.rod_centre);
    let (sine, cosine) = angle.sin_cos();
    let lean = (r * sine / l).asin();
    let (lean_sine, lean_cosine) = lean.sin_cos();
    // l sin(lean) = r sin(angle), so the rates of lean follow
    let rate = r * cosine / (l * lean_cosine);
    let bend = (l * lean_sine * rate * rate - r * sine) / (l * lean_cosine);
    let along = |share: f64| {
        let reach = share * l;
        (-r * sine - reach * lean_sine * rate, -r * cosine - reach * (lean_cosine * rate * rate + lean_sine * bend))
    };
    let (slider, centre) = (along(1.0), along(f));
    let height = ((1.0 - f) * r * cosine, -(1.0 - f) * r * sine);
    let inertia = crank.slider_mass * slider.0 * slider.0
        + crank.rod_mass * (centre.0 * centre.0 + height.0 * height.0)
        + crank.rod_inertia * rate * rate;
    let half = crank.slider_mass * slider.0 * slider.1
        + crank.rod_mass * (centre.0 * centre.1 + height.0 * height.1)
        + crank.rod_inertia * rate * bend;
    (inertia, 2.0 * half)
}
