//! The steady cycle of a machine whose torques and inertias follow an angle.

use std::f64::consts::TAU;

use super::converge::Recording;
use super::motion::Motion;
use super::signal::Signal;

/// Share by which two extrapolated cycles may differ for the machine to be called steady.
const STEADY: f64 = 1e-10;
/// Share by which a change from cycle to cycle falls off at least, and the change below which it is rounding.
const FALLS: (f64, f64) = (0.9999, 1e-13);
/// Times that a cycle may take of what it would at the speed of its start.
const SLOWEST: f64 = 100.0;
/// Share of a peak to which a cycle comes back.
const RETURNS: f64 = 1e-9;
/// Share of a cycle before whose end trials begin.
const NEAR: f64 = 0.02;

/// The cycle that a machine settles to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cycle {
    /// Greatest speed of the coordinate, rad/s.
    pub greatest: f64,
    /// Least speed, rad/s.
    pub least: f64,
    /// s.
    pub time: f64,
    /// Mean speed over the time, rad/s.
    pub mean: f64,
    /// Cycles that were run.
    pub cycles: usize,
}

impl Cycle {
    /// Coefficient of speed fluctuation: greatest less least speed over the mean.
    #[must_use]
    pub fn delta(&self) -> f64 {
        (self.greatest - self.least) / self.mean
    }
}

impl Motion {
    /// Runs on by cycles of so many turns of a coordinate until they repeat, `most` at most. What is left of a start
    /// dies out by the same share from cycle to cycle, and is taken off by Aitken's extrapolation. None where the
    /// coordinate stops, runs backwards or goes on changing, and where a cycle takes a hundred times as long as it
    /// would at the speed of its start. `told` gets the number of each cycle that is to be run.
    pub fn steady_cycle(&mut self, coordinate: usize, turns: u32, most: usize, told: impl Fn(usize)) -> Option<Cycle> {
        let mut last: Vec<[f64; 3]> = Vec::new();
        let mut before: Option<[f64; 3]> = None;
        for cycles in 1..=most {
            told(cycles);
            let begun = self.time();
            self.watch(Signal::Speed(coordinate));
            self.turn(coordinate, TAU * f64::from(turns))?;
            let extremes = self.extremes(Signal::Speed(coordinate))?;
            last.push([extremes.peak, extremes.least, self.time() - begun]);
            let [.., a, b, c] = &last[..] else { continue };
            let end: [f64; 3] = std::array::from_fn(|i| aitken(a[i], b[i], c[i]));
            let alike = |other: [f64; 3]| end.iter().zip(other).all(|(x, y)| (x - y).abs() <= STEADY * x.abs());
            let falls = (0..3).all(|i| {
                let (first, second) = ((b[i] - a[i]).abs(), (c[i] - b[i]).abs());
                second <= FALLS.0 * first || second <= FALLS.1 * c[i].abs()
            });
            if falls && before.is_some_and(alike) {
                let [greatest, least, time] = end;
                return Some(Cycle { greatest, least, time, mean: TAU * f64::from(turns) / time, cycles });
            }
            before = Some(end);
        }
        None
    }

    /// The steady cycle run for its proof: on from where [`steady_cycle`](Self::steady_cycle) has left off, by `most`
    /// cycles at most, until speeds and elongations come back to 1e-9 of their peaks; then one more cycle, written down
    /// in `steps` steps of equal time, with its speed watched. The largest share that does not come back belongs to it.
    /// None and `told` as there.
    pub fn closed_cycle(
        mut self,
        coordinate: usize,
        turns: u32,
        most: usize,
        steps: u32,
        told: impl Fn(usize),
    ) -> Option<(Recording, f64)> {
        let angle = TAU * f64::from(turns);
        for cycle in 0..=most {
            told(cycle);
            self.watches.clear();
            let begun = self.clone();
            for signal in (0..self.coordinates()).map(Signal::Speed).chain((0..self.links()).map(Signal::Elongation)) {
                self.watch(signal);
            }
            self.turn(coordinate, angle)?;
            let residual = self.residual(&begun)?;
            if residual > RETURNS && cycle < most {
                continue;
            }
            let time = self.time() - begun.time();
            let mut start = begun.afresh();
            start.watch(Signal::Speed(coordinate));
            let mut run = Recording::new(start);
            (0..steps).for_each(|_| run.advance(time / f64::from(steps)));
            return Some((run, residual));
        }
        None
    }

    /// The motion from here on, as one that begins in this state at this time.
    fn afresh(&self) -> Self {
        let mut train = self.train.clone();
        for (j, coordinate) in train.coordinates.iter_mut().enumerate() {
            (coordinate.speed, coordinate.angle) = (self.state.speed[j], self.state.angle[j]);
        }
        for (link, elongation) in train.links.iter_mut().zip(&self.state.elongation) {
            link.elongation = *elongation;
        }
        let mut afresh = Self::new(train);
        (afresh.held, afresh.event_tolerance) = (self.held.clone(), self.event_tolerance);
        (afresh.clock, afresh.now) = ((self.now, 0.0), self.now);
        afresh
    }

    /// Largest change of a speed or an elongation since another state, as a share of its peak.
    fn residual(&self, begun: &Self) -> Option<f64> {
        let (n, links) = (self.coordinates(), self.links());
        let changes = self.state.speed.iter().zip(&begun.state.speed).map(|(now, then)| (now - then).abs());
        let changes = changes
            .chain(self.state.elongation.iter().zip(&begun.state.elongation).map(|(now, then)| (now - then).abs()));
        let signals = (0..n).map(Signal::Speed).chain((0..links).map(Signal::Elongation));
        let mut largest = 0.0_f64;
        for (change, signal) in changes.zip(signals) {
            let peak = self.extremes(signal).map(|e| e.peak.abs().max(e.least.abs()))?;
            if peak > 0.0 {
                largest = largest.max(change / peak);
            }
        }
        Some(largest)
    }

    /// On until a coordinate has turned by an angle, rad.
    fn turn(&mut self, coordinate: usize, angle: f64) -> Option<()> {
        let (begun, end) = (self.time(), self.angle(coordinate) + angle);
        let whole = angle / self.speed(coordinate);
        while end - self.angle(coordinate) > NEAR * angle {
            let speed = self.speed(coordinate);
            if !(speed > 0.0 && self.time() - begun < SLOWEST * whole) {
                return None;
            }
            let mut length = (0.5 * (end - self.angle(coordinate)) / speed).min(whole);
            let mut after = self.clone();
            after.advance(length);
            // what speeds up goes beyond the end
            while after.angle(coordinate) > end {
                length *= 0.5;
                after = self.clone();
                after.advance(length);
            }
            *self = after;
        }
        let mut time = (end - self.angle(coordinate)) / self.speed(coordinate);
        for _ in 0..8 {
            let mut trial = self.clone();
            trial.watches.clear();
            trial.advance(time);
            time += (end - trial.angle(coordinate)) / trial.speed(coordinate);
        }
        if !(time.is_finite() && time > 0.0) {
            return None;
        }
        self.advance(time);
        Some(())
    }
}

/// The limit of a sequence whose differences fall off by the same share.
fn aitken(a: f64, b: f64, c: f64) -> f64 {
    let (first, second) = (b - a, c - b);
    // differences of roundings have no share
    if second.abs() >= first.abs() || first.abs() < 1e-13 * c.abs() {
        return c;
    }
    c + second * second / (first - second)
}
