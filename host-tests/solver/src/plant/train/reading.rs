//! Readings of a train in motion.

use super::motion::Motion;
use super::series::{Series, ZERO, value};
use super::signal::{Signal, Watch};
use super::stretch::Stretch;
use crate::plant::event::Event;
use crate::plant::extremes::Extremes;
use crate::plant::root::{derivative, sign_changes};

impl Motion {
    /// Looks at the part of the stretch up to `share`: both ends and every place where the rate is zero.
    pub(super) fn look(&self, watch: &mut Watch, stretch: &Stretch, share: f64) {
        let Some(series) = self.series(stretch, watch.signal) else { return };
        let mut places = vec![0.0, share];
        // near an extreme an error of 1e-12 of the stretch changes the value by the square of that
        places.extend(sign_changes(&derivative(&series), 1e-12).into_iter().filter(|&p| p < share));
        for place in places {
            watch.extremes.take(value(&series, place), self.now + place * stretch.length);
        }
    }

    /// Time since the start, s.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.now
    }

    /// How many coordinates there are.
    #[must_use]
    pub fn coordinates(&self) -> usize {
        self.train.coordinates.len()
    }

    /// How many links there are.
    #[must_use]
    pub fn links(&self) -> usize {
        self.train.links.len()
    }

    /// Inertia of a coordinate, kg m2; NaN for one that is not there, or whose crank changes it.
    #[must_use]
    pub fn inertia(&self, coordinate: usize) -> f64 {
        let coordinate = self.train.coordinates.get(coordinate).filter(|coordinate| !coordinate.is_cranked());
        coordinate.map_or(f64::NAN, |coordinate| coordinate.inertia)
    }

    /// Kinetic energy of all coordinates, J.
    #[must_use]
    pub fn kinetic_energy(&self) -> f64 {
        let moving = self.train.coordinates.iter().zip(self.state.angle.iter().zip(&self.state.speed));
        moving.map(|(coordinate, (angle, speed))| 0.5 * coordinate.inertia_at(*angle) * speed * speed).sum()
    }

    /// Whether a link carries nothing now: a gap is open, or a rope slack.
    #[must_use]
    pub fn is_open(&self) -> bool {
        (0..self.train.links.len()).any(|link| !self.mode.carries(&self.train, link))
    }

    /// Whether a link has backlash. A rope has none.
    #[must_use]
    pub fn has_backlash(&self) -> bool {
        self.train.links.iter().any(|link| !link.rope && link.gap > 0.0)
    }

    /// Angle of a coordinate, rad; NaN for one that is not there.
    #[must_use]
    pub fn angle(&self, coordinate: usize) -> f64 {
        self.state.angle.get(coordinate).copied().unwrap_or(f64::NAN)
    }

    /// Speed of a coordinate, rad/s; NaN for one that is not there.
    #[must_use]
    pub fn speed(&self, coordinate: usize) -> f64 {
        self.state.speed.get(coordinate).copied().unwrap_or(f64::NAN)
    }

    /// Of each dry friction its coordinates with their shares, its torque while it slides (N m or N), and how far it has
    /// come over its surface since time zero, with the sign of its first coordinate (rad or m).
    pub fn slides(&self) -> impl Iterator<Item = (&[(usize, f64)], f64, f64)> + '_ {
        self.train.frictions.iter().map(|friction| {
            let moved = |&(at, share): &(usize, f64)| share * self.angle(at);
            let along = friction.terms.iter().map(moved).sum::<f64>() - friction.surface * self.now;
            (&*friction.terms, friction.kinetic, along)
        })
    }

    /// Elongation of a link, rad or m; NaN for one that is not there.
    #[must_use]
    pub fn elongation(&self, link: usize) -> f64 {
        self.state.elongation.get(link).copied().unwrap_or(f64::NAN)
    }

    /// Force of a link, N m or N, positive when it is stretched; NaN for one that is not there.
    #[must_use]
    pub fn force(&self, link: usize) -> f64 {
        match self.train.links.get(link) {
            Some(_) if !self.mode.carries(&self.train, link) => 0.0,
            Some(fixed) if fixed.variation.is_none() => {
                let rate: f64 = fixed.terms.iter().map(|&(at, share)| share * self.state.speed[at]).sum();
                let stretch = self.state.elongation[link] - fixed.origin(self.mode.contact[link]);
                fixed.stiffness * stretch + fixed.damping * rate
            }
            _ => self.read(Signal::Force(link)),
        }
    }

    /// Contact of a link: +1 drive side, -1 back side, 0 in the gap, slack for a rope.
    #[must_use]
    pub fn contact(&self, link: usize) -> i8 {
        self.mode.contact.get(link).copied().filter(|contact| contact.abs() == 1).unwrap_or(0)
    }

    /// Any signal; NaN for one that is not there.
    #[must_use]
    pub fn read(&self, signal: Signal) -> f64 {
        self.read_all(&[signal])[0]
    }

    /// Several signals at once, for less than one by one.
    #[must_use]
    pub fn read_all(&self, signals: &[Signal]) -> Vec<f64> {
        // only the coefficients of order zero are looked at
        let length = self.longest(1.0);
        let stretch = Stretch::now(&self.train, &self.mode, &self.state, &self.held, self.now, length);
        signals.iter().map(|&signal| self.series(&stretch, signal).map_or(f64::NAN, |series| series[0])).collect()
    }

    /// Begins to watch the extremes of a signal, found where its rate is zero and not on a grid of samples.
    pub fn watch(&mut self, signal: Signal) {
        let extremes = Extremes::of(self.read(signal), self.now);
        self.watches.retain(|watch| watch.signal != signal);
        self.watches.push(Watch { signal, extremes });
    }

    /// Extremes of a signal since [`watch`](Self::watch) was called for it.
    #[must_use]
    pub fn extremes(&self, signal: Signal) -> Option<Extremes> {
        self.watches.iter().find(|watch| watch.signal == signal).map(|watch| watch.extremes)
    }

    /// Every event so far, in order of time. A link is called a shaft, a coordinate a node.
    #[must_use]
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// Forgets the events so far, for long runs.
    pub fn clear_events(&mut self) {
        self.events.clear();
    }

    pub(super) fn series(&self, stretch: &Stretch, signal: Signal) -> Option<Series> {
        let carried = |l: usize| if self.mode.carries(&self.train, l) { 1.0 } else { 0.0 };
        match signal {
            Signal::Angle(j) => stretch.angle.get(j).map(|s| s.value),
            Signal::Speed(j) => stretch.speed.get(j).map(|s| s.value),
            Signal::Elongation(l) => stretch.elongation.get(l).map(|s| s.value),
            Signal::Force(l) => stretch.strain.get(l).map(|s| s.value.map(|v| v * carried(l))),
            Signal::Elastic(l) => {
                let link = self.train.links.get(l)?;
                let mut series = stretch.strain[l].value;
                for &(at, share) in &link.terms {
                    for (k, v) in series.iter_mut().enumerate() {
                        *v -= link.damping * share * stretch.speed[at].value[k];
                    }
                }
                let last = series.len() - 1;
                if let Some(variation) = &link.variation {
                    let error = variation.over(link.stiffness, self.now, stretch.length, self.mode.edge(l)).1;
                    for k in 0..last {
                        series[k] += link.damping * (k + 1) as f64 / stretch.length * error[k + 1];
                    }
                }
                series[last] = 0.0;
                Some(series.map(|v| v * carried(l)))
            }
            Signal::Outside(j) => {
                let speed = &stretch.speed.get(j)?.value;
                // of a gear with no shaft behind it, what is behind it
                let gear = self.mode.gears.iter().position(|flow| flow.at == j);
                let coordinate = &self.train.coordinates[j];
                let inertia = coordinate.inertia - coordinate.gear.map_or(0.0, |gear| gear.front);
                let mut series = ZERO;
                for (k, to) in series.iter_mut().enumerate().take(speed.len() - 1) {
                    *to = inertia * (k + 1) as f64 / stretch.length * speed[k + 1];
                }
                for (l, link) in self.train.links.iter().enumerate() {
                    let Some(i) = link.terms.iter().position(|term| term.0 == j) else { continue };
                    if gear.is_some() && i > 0 {
                        continue;
                    }
                    let loss = if i == 0 { self.mode.loss(&self.train, l) } else { 1.0 };
                    let share = link.terms[i].1 * loss * carried(l);
                    for (to, force) in series.iter_mut().zip(&stretch.strain[l].value) {
                        *to += share * force;
                    }
                }
                if let Some(g) = gear {
                    series.iter_mut().zip(&stretch.gear[g].value).for_each(|(to, torque)| *to -= torque);
                }
                Some(series)
            }
            Signal::Friction(s) => {
                let zero = ZERO;
                stretch.friction.get(s).map(|s| {
                    let mut series = zero;
                    series.iter_mut().zip(s.value).for_each(|(to, v)| *to = -v);
                    series
                })
            }
        }
    }
}
