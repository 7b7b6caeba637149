//! Events: what ends a stretch, and what then changes.

use super::Variation;
use super::motion::Motion;
use super::series::Series;
use super::signal::Watch;
use super::state::TRAILING;
use super::stretch::Stretch;
use crate::plant::event::{Event, EventKind, Place};
use crate::plant::root::first_fall;

/// Events in one tick after which the rest of it is run without any.
const MOST_EVENTS: usize = 1000;

/// Action of a fallen guard.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Action {
    /// The contact of the link becomes this.
    Contact(usize, i8),
    /// The torque of the link changes its sign.
    Flow(usize),
    /// The torque behind the gear that has no shaft changes its sign, sliding or about to slide this way.
    Gear(usize, i8),
    /// The friction has come to rest.
    Stop(usize),
    /// The friction breaks loose in this direction.
    Slip(usize, i8),
    /// The arc's ends passed become one more or one less.
    Arc(usize, i64),
    /// The ends passed by a crank with friction in its pins become one more or one less.
    Pin(usize, i64),
    /// The force in the rod of such a crank reverses.
    Rod(usize),
    /// The tooth edge ahead becomes the next or the one before.
    Tooth(usize, i64),
}

impl Motion {
    /// From event to event until a time, s.
    pub(super) fn run_to(&mut self, end: f64) {
        let mut events = 0;
        // Rounding error of the clock: stretches of one length would lose the same each time, and teeth would meet
        // 1e-11 s late after seconds.
        let mut lost = 0.0;
        while self.now < end {
            let left = (end - self.now) - lost;
            let stretch = self.stretch(self.longest(left));
            let found = if events < MOST_EVENTS { self.first_event(&stretch) } else { None };
            let share = found.map_or(1.0, |(share, _)| share);
            // what an event ends where it began was not there
            if share > 0.0 {
                self.watches(&stretch, share);
                self.state = stretch.at(share);
            }
            let whole = share == 1.0 && stretch.length >= left;
            let step = share * stretch.length + lost;
            let next = if whole { end } else { self.now + step };
            lost = step - (next - self.now);
            self.now = next;
            if self.state.speed.iter().any(|speed| !speed.is_finite()) {
                // beyond the numbers: nothing is left to solve
                self.now = end;
            } else if let Some((_, action)) = found {
                events += 1;
                self.fired += 1;
                self.fire(action);
                if events == MOST_EVENTS {
                    self.log(EventKind::Unresolved, Place::Node(0), 0);
                }
            }
        }
    }

    /// What a switch of stiffness opens or closes, or turns round, now.
    pub(super) fn switch(&mut self) {
        for _ in 0..MOST_EVENTS {
            let Some((0.0, action)) = self.first_event(&self.stretch(self.longest(1.0))) else { return };
            self.fired += 1;
            self.fire(action);
        }
    }

    fn watches(&mut self, stretch: &Stretch, share: f64) {
        let mut watches: Vec<Watch> = std::mem::take(&mut self.watches);
        for watch in &mut watches {
            self.look(watch, stretch, share);
        }
        self.watches = watches;
    }

    /// The first guard to fall on the stretch, and where, as a share of it.
    fn first_event(&self, stretch: &Stretch) -> Option<(f64, Action)> {
        let tolerance = (self.event_tolerance / stretch.length).max(4.0 * f64::EPSILON);
        let mut first: Option<(f64, Action)> = None;
        self.guards(stretch, |action, (poly, rounding)| {
            if let Some(share) = first_fall(&poly, &rounding, tolerance)
                && first.is_none_or(|(earliest, _)| share < earliest)
            {
                first = Some((share, action));
            }
        });
        first
    }

    /// All quantities that must not fall below zero while the stretch lasts.
    pub(super) fn guards(&self, stretch: &Stretch, mut add: impl FnMut(Action, (Series, Series))) {
        for (l, link) in self.train.links.iter().enumerate().filter(|(_, link)| !link.is_linear()) {
            let (x, force) = (&stretch.approach[l], &stretch.strain[l]);
            let reach = link.origin(1);
            let contact = self.mode.contact[l];
            let side = f64::from(contact.signum());
            match contact.abs() {
                0 => {
                    add(Action::Contact(l, 1), x.guard(-1.0, reach));
                    if !link.rope {
                        add(Action::Contact(l, -1), x.guard(1.0, reach));
                    }
                }
                1 => {
                    let left = if link.damping > 0.0 { contact * TRAILING } else { 0 };
                    add(Action::Contact(l, left), force.guard(side, 0.0));
                    if left != 0 && link.jumps() {
                        // an error parts flanks that close in on each other
                        add(Action::Contact(l, 0), x.guard(side, -reach));
                    }
                }
                _ => {
                    add(Action::Contact(l, contact.signum()), force.guard(-side, 0.0));
                    add(Action::Contact(l, 0), x.guard(side, -reach));
                }
            }
        }
        for (l, link) in self.train.links.iter().enumerate() {
            // a contact carries one sign alone
            if link.is_lossy() && link.is_linear() {
                let factor = f64::from(self.mode.flow[l]) * link.terms[0].1.signum();
                add(Action::Flow(l), stretch.strain[l].guard(factor, 0.0));
            }
        }
        for (g, flow) in self.mode.gears.iter().enumerate() {
            let slip = self.mode.slip[flow.friction];
            for side in [1, -1].into_iter().filter(|&side| slip == 0 || slip == side) {
                let sign = f64::from(flow.sign[usize::from(side < 0)]);
                add(Action::Gear(g, side), stretch.gear[g].guard(sign, sign * self.gear_friction(g, side)));
            }
        }
        for (s, friction) in self.train.frictions.iter().enumerate() {
            let slip = self.mode.slip[s];
            if slip != 0 {
                add(Action::Stop(s), self.relative(stretch, s, f64::from(slip)));
                continue;
            }
            for side in [1, -1] {
                add(Action::Slip(s, side), self.hold(stretch, s, side, friction.breakaway));
            }
        }
        for arc in 0..self.mode.arcs.len() {
            let (j, s, passed) = self.mode.arcs[arc];
            let over_speed = self.train.coordinates[j].sources[s].ends().is_some();
            let at = if over_speed { &stretch.speed[j] } else { &stretch.angle[j] };
            let (ahead, behind) = (self.arcs_end(arc, passed), self.arcs_end(arc, passed - 1));
            if ahead.is_finite() {
                add(Action::Arc(arc, 1), at.guard(-1.0, ahead));
            }
            if behind.is_finite() {
                add(Action::Arc(arc, -1), at.guard(1.0, -behind));
            }
        }
        for (i, pinning) in self.mode.pins.iter().enumerate() {
            add(Action::Rod(i), stretch.rod[i].guard(pinning.pull, 0.0));
            if let Some(pinned) = &self.train.coordinates[pinning.at].pins {
                let angle = &stretch.angle[pinning.at];
                add(Action::Pin(i, 1), angle.guard(-1.0, pinned.end(pinning.passed)));
                add(Action::Pin(i, -1), angle.guard(1.0, -pinned.end(pinning.passed - 1)));
            }
        }
        for (i, &(l, edge)) in self.mode.teeth.iter().enumerate() {
            if let Some(Variation::Teeth(teeth)) = &self.train.links[l].variation {
                let angle = &stretch.angle[teeth.coordinate];
                add(Action::Tooth(i, 1), angle.guard(-1.0, teeth.edge(edge)));
                add(Action::Tooth(i, -1), angle.guard(1.0, -teeth.edge(edge - 1)));
            }
        }
    }

    /// The speed of a friction over its surface, times a sign.
    fn relative(&self, stretch: &Stretch, s: usize, sign: f64) -> (Series, Series) {
        let friction = &self.train.frictions[s];
        let mut sum = ([0.0; _], [0.0; _]);
        for &(at, share) in &friction.terms {
            let (values, rounding) = stretch.speed[at].guard(sign * share, 0.0);
            add_to(&mut sum, &values, &rounding);
        }
        sum.0[0] -= sign * friction.surface;
        sum
    }

    /// What dry friction adds to the torque behind a gear before it slides towards `side`.
    fn gear_friction(&self, gear: usize, side: i8) -> f64 {
        let friction = self.mode.gears[gear].friction;
        if self.mode.slip[friction] == 0 { f64::from(side) * self.train.frictions[friction].breakaway } else { 0.0 }
    }

    /// Signs of the torques behind the gears, as they are now.
    fn face_gears(&mut self) {
        let now = Stretch::now(&self.train, &self.mode, &self.state, &self.held, self.now, self.longest(1.0));
        for g in 0..self.mode.gears.len() {
            for (i, side) in [1, -1].into_iter().enumerate() {
                let torque = now.gear[g].value[0] + self.gear_friction(g, side);
                self.mode.gears[g].sign[i] = if torque < 0.0 { -1 } else { 1 };
            }
        }
    }

    /// How far the force that holds a friction is from letting it slip towards `side`.
    fn hold(&self, stretch: &Stretch, s: usize, side: i8, breakaway: f64) -> (Series, Series) {
        let gear = self.mode.gears.iter().position(|flow| flow.friction == s);
        let factor = gear.map_or(1.0, |g| {
            let flow = &self.mode.gears[g];
            self.train.coordinates[flow.at].gear.map_or(1.0, |gear| flow.factor(&gear, side))
        });
        let mut sum = stretch.friction[s].guard(f64::from(side), factor * breakaway);
        if let Some(g) = gear {
            let (values, rounding) = stretch.gear[g].guard(f64::from(side) * (factor - 1.0), 0.0);
            add_to(&mut sum, &values, &rounding);
        }
        for &l in &self.train.frictions[s].losses {
            if self.mode.carries(&self.train, l) {
                // motoring, a gear needs 1/eta of the torque; overhauling, it passes eta of it
                let link = &self.train.links[l];
                let driving = side * self.mode.flow[l] > 0;
                let torque = f64::from(side) * (link.factor(driving) - 1.0) * link.terms[0].1;
                let (values, rounding) = stretch.strain[l].guard(torque, 0.0);
                add_to(&mut sum, &values, &rounding);
            }
        }
        sum
    }

    /// Switches the mode as a fallen guard calls for.
    fn fire(&mut self, action: Action) {
        match action {
            Action::Contact(l, new) => {
                let was = self.mode.contact[l];
                self.mode.contact[l] = new;
                if new.abs() == 1 {
                    self.mode.flow[l] = new * self.train.links[l].terms[0].1.signum() as i8;
                }
                // a trailing contact is open to the outside
                let shown = |contact: i8| if contact.abs() == TRAILING { 0 } else { contact };
                if shown(was) != shown(new) {
                    self.log(EventKind::Contact, Place::Shaft(l), shown(new));
                }
            }
            Action::Flow(l) => {
                self.mode.flow[l] = -self.mode.flow[l];
                self.log(EventKind::Flow, Place::Shaft(l), self.mode.flow[l]);
            }
            Action::Gear(g, side) => {
                let sign = &mut self.mode.gears[g].sign[usize::from(side < 0)];
                *sign = -*sign;
                let (new, at) = (*sign, self.mode.gears[g].at);
                self.log(EventKind::Flow, Place::Node(at), new);
            }
            Action::Stop(s) => {
                self.rest(s);
                self.mode.slip[s] = 0;
                self.mode.gather(&self.train);
                self.face_gears();
                self.let_go(s);
                let new = self.mode.slip[s];
                let kind = if new == 0 { EventKind::Stop } else { EventKind::Reversal };
                self.log(kind, Place::Node(self.train.frictions[s].terms[0].0), new);
            }
            Action::Slip(s, new) => {
                self.mode.slip[s] = new;
                self.mode.gather(&self.train);
                self.log(EventKind::Slip, Place::Node(self.train.frictions[s].terms[0].0), new);
            }
            Action::Arc(arc, step) => self.mode.arcs[arc].2 += step,
            Action::Pin(i, step) => self.mode.pins[i].passed += step,
            Action::Rod(i) => self.mode.pins[i].pull *= -1.0,
            Action::Tooth(i, step) => self.mode.teeth[i].1 += step,
        }
    }

    /// Takes the last rounding from a speed that has come to rest.
    fn rest(&mut self, s: usize) {
        let friction = &self.train.frictions[s];
        if let [(at, _)] = friction.terms[..] {
            self.state.speed[at] = friction.surface;
            return;
        }
        let inertia = |at: usize| self.train.coordinates[at].inertia;
        let (mut over, mut weight) = (-friction.surface, 0.0);
        for &(at, share) in &friction.terms {
            over += share * self.state.speed[at];
            weight += share * share / inertia(at);
        }
        let shares: Vec<(usize, f64)> = friction.terms.iter().map(|&(at, c)| (at, c / inertia(at))).collect();
        for (at, share) in shares {
            self.state.speed[at] -= share * over / weight;
        }
    }

    /// Lets a friction slide that would have to hold more than it can.
    pub(super) fn let_go(&mut self, s: usize) {
        let breakaway = self.train.frictions[s].breakaway;
        let stretch = self.stretch(self.longest(f64::MAX));
        for side in [1, -1] {
            // what is nothing but for its rounding lets go only if it falls
            let (room, rounding) = self.hold(&stretch, s, side, breakaway);
            if first_fall(&room, &rounding, 1.0) == Some(0.0) {
                self.mode.slip[s] = side;
            }
        }
        self.mode.gather(&self.train);
    }

    /// Lets the closed contacts trail whose dampers would make them pull.
    pub(super) fn trail(&mut self) {
        let now = Stretch::now(&self.train, &self.mode, &self.state, &self.held, self.now, self.longest(1.0));
        for (l, link) in self.train.links.iter().enumerate().filter(|(_, link)| !link.is_linear()) {
            let side = self.mode.contact[l].signum();
            let pulls = now.strain[l].value[0] * f64::from(side) < 0.0 && link.damping > 0.0;
            self.mode.contact[l] = if pulls { side * TRAILING } else { side };
        }
    }

    /// The mode that belongs to the state at the start.
    pub(super) fn settle(&mut self) {
        for s in 0..self.train.frictions.len() {
            let friction = &self.train.frictions[s];
            let terms = friction.terms.iter();
            let over: f64 = terms.map(|&(at, share)| share * self.state.speed[at]).sum::<f64>() - friction.surface;
            self.mode.slip[s] = if over > 0.0 { 1 } else { -i8::from(over < 0.0) };
        }
        self.mode.gather(&self.train);
        self.trail();
        let stretch = self.stretch(self.longest(f64::MAX));
        for l in 0..self.train.links.len() {
            let force = stretch.strain[l].value[0];
            self.mode.flow[l] = if force * self.train.links[l].terms[0].1 < 0.0 { -1 } else { 1 };
        }
        self.face_gears();
        for s in 0..self.train.frictions.len() {
            if self.mode.slip[s] == 0 {
                self.let_go(s);
            }
        }
    }

    fn log(&mut self, kind: EventKind, place: Place, new: i8) {
        self.events.push(Event { time: self.now, kind, place, new });
    }
}

fn add_to(sum: &mut (Series, Series), values: &Series, rounding: &Series) {
    for k in 0..values.len() {
        sum.0[k] += values[k];
        sum.1[k] += rounding[k];
    }
}
