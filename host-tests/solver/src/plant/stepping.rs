//! The step: a leap over a tick that certainly holds no event, or a walk from event to event.

use super::dense::dot;
use super::event::{Event, EventKind, Place};
use super::guard::{Action, Tick};
use super::mode::TRAILING;
use super::root::first_fall;
use super::solver::Plant;
use super::taylor::Stretch;

/// Events in one tick after which the rest of it is run without any.
const MOST_EVENTS: usize = 1000;

impl Plant {
    /// Runs on by `dt` seconds (above zero) with `motor_torque` (N m) held, beside the motor's own law if it has one.
    ///
    /// Exact up to rounding between events; ticks of equal length share their matrices. A torque that is not finite or
    /// a length that is not above zero changes nothing and counts as [`refused`](Self::refused).
    pub fn advance(&mut self, motor_torque: f64, dt: f64) {
        if !(motor_torque.is_finite() && dt.is_finite() && dt > 0.0) {
            self.refused += 1;
            return;
        }
        let start = self.clock.0;
        self.held_torque = motor_torque;
        self.set_outer(start);
        if !self.settled {
            self.settled = true;
            self.settle_motion();
            self.enter_mode();
        }
        let end = start + dt;
        let mut now = start;
        while let Some(corner) = self.corner_after(now).filter(|&corner| corner < end) {
            self.run(corner - now, false);
            now = corner;
            self.elapsed = now - start;
            self.set_outer(now);
            if self.chain.law.corner_after(start) == Some(now) {
                self.log(EventKind::MotorLaw, Place::Node(0), 0);
            }
        }
        if now == start {
            self.run(dt, true);
        } else {
            self.run(end - now, false);
        }
        self.elapsed = 0.0;
        self.tick_clock(dt);
    }

    fn corner_after(&self, time: f64) -> Option<f64> {
        let loads = self.chain.nodes.iter().filter_map(|node| node.program.as_ref()?.corner_after(time));
        loads.chain(self.chain.law.corner_after(time)).reduce(f64::min)
    }

    /// Adds to the clock and keeps what rounding loses (Neumaier's sum).
    fn tick_clock(&mut self, dt: f64) {
        let (clock, lost) = self.clock;
        let step = dt + lost;
        let sum = clock + step;
        self.clock = (sum, if clock >= step { (clock - sum) + step } else { (step - sum) + clock });
    }

    fn run(&mut self, length: f64, whole_tick: bool) {
        if !(whole_tick && self.leap(length)) {
            self.walk(length);
        }
    }

    /// One exact step, if every guard certainly stays above zero on the way.
    fn leap(&mut self, length: f64) -> bool {
        if self.extremes.is_some() {
            return false;
        }
        let ramped = self.ramped;
        let total: Vec<f64> = self.outer.iter().zip(&self.mode_torque).map(|(a, b)| a + b).collect();
        let regime = &mut self.regimes[self.current];
        let Some(step) = regime.step_of(length) else {
            return false;
        };
        step.apply(&self.x, &total, &self.outer_rate, ramped, &mut self.next);
        if !self.guards.is_empty() {
            let energy_norm =
                |v: &[f64]| v.iter().zip(&regime.energy).map(|(v, e)| (v * e) * (v * e)).sum::<f64>().sqrt();
            regime.a.times(&self.x, &mut self.rate);
            let mut rise = 0.0;
            for (i, rate) in self.rate.iter_mut().enumerate() {
                *rate += dot(regime.b.row(i), &total);
                if ramped {
                    rise += (dot(regime.b.row(i), &self.outer_rate) * regime.energy[i]).powi(2);
                }
            }
            let norm = (energy_norm(&self.rate) + length * rise.sqrt()) * (regime.growth * length).exp();
            let force_after: Vec<f64> = self.outer.iter().zip(&self.outer_rate).map(|(f, r)| f + r * length).collect();
            let tick = Tick {
                before: &self.x,
                after: &self.next,
                rate_before: &self.rate,
                force_before: &self.outer,
                force_after: &force_after,
                force_rate: if ramped { &self.outer_rate } else { &[] },
                rate_norm: norm,
                length,
            };
            if !self.guards.iter().all(|guard| guard.passes(&tick)) {
                return false;
            }
        }
        std::mem::swap(&mut self.x, &mut self.next);
        self.ramp(length);
        true
    }

    /// From event to event, in stretches short enough for their Taylor series.
    fn walk(&mut self, length: f64) {
        let mut left = length;
        let mut events = 0;
        while left > 0.0 {
            let regime = &self.regimes[self.current];
            let piece = if regime.rate * left > 1.0 { 1.0 / regime.rate } else { left };
            let total: Vec<f64> = self.outer.iter().zip(&self.mode_torque).map(|(a, b)| a + b).collect();
            let stretch = Stretch::new(regime, &self.x, &total, &self.outer_rate, piece);
            let found = if events < MOST_EVENTS { self.first_event(&stretch) } else { None };
            let share = found.map_or(1.0, |(share, _)| share);
            self.note_extremes(&stretch, share);
            let passed = share * piece;
            if share > 0.0 {
                self.x = stretch.at(share);
            }
            self.elapsed += passed;
            self.ramp(passed);
            left = if share == 1.0 && piece == left { 0.0 } else { left - passed };
            if let Some((_, action)) = found {
                events += 1;
                self.fire(action);
                if events == MOST_EVENTS {
                    self.log(EventKind::Unresolved, Place::Node(0), 0);
                }
            }
        }
    }

    fn ramp(&mut self, length: f64) {
        if self.ramped {
            for (outer, rate) in self.outer.iter_mut().zip(&self.outer_rate) {
                *outer += rate * length;
            }
        }
    }

    /// The first guard to fall on the stretch, and where, as a share of it.
    fn first_event(&self, stretch: &Stretch) -> Option<(f64, Action)> {
        let tolerance = (self.event_tolerance / stretch.length).max(4.0 * f64::EPSILON);
        let mut first: Option<(f64, Action)> = None;
        for guard in &self.guards {
            let constant = dot(&guard.force, &self.outer) + guard.constant;
            let slope = dot(&guard.force, &self.outer_rate);
            let (form, rounding) = stretch.form(&guard.row, constant, slope);
            let Some(share) = first_fall(&form, &rounding, tolerance) else {
                continue;
            };
            if first.is_none_or(|(earliest, _)| share < earliest) {
                first = Some((share, guard.action));
            }
        }
        first
    }

    /// Switches the mode as a fallen guard calls for.
    fn fire(&mut self, action: Action) {
        match action {
            Action::Contact(shaft, new) => {
                let was = self.mode.contact[shaft];
                self.mode.contact[shaft] = new;
                if new.abs() == 1 {
                    self.mode.flow[shaft] = new;
                }
                // a trailing contact is open to the outside
                let shown = |contact: i8| if contact.abs() == TRAILING { 0 } else { contact };
                if shown(was) != shown(new) {
                    self.log(EventKind::Contact, Place::Shaft(shaft), shown(new));
                }
            }
            Action::Stop(node) => {
                let speed = self.layout.speed(node);
                self.x[speed] = 0.0;
                self.settle_node(node);
                let new = self.mode.motion[node];
                let kind = if new == 0 { EventKind::Stop } else { EventKind::Reversal };
                self.log(kind, Place::Node(node), new);
            }
            Action::Slip(node, new) => {
                self.mode.motion[node] = new;
                self.log(EventKind::Slip, Place::Node(node), new);
            }
            Action::Flow(shaft) => {
                self.mode.flow[shaft] = -self.mode.flow[shaft];
                self.log(EventKind::Flow, Place::Shaft(shaft), self.mode.flow[shaft]);
            }
        }
        self.enter_mode();
    }

    fn log(&mut self, kind: EventKind, place: Place, new: i8) {
        self.events.push(Event { time: self.clock.0 + self.elapsed, kind, place, new });
    }
}
