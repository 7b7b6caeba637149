//! Proof of a recorded run of a train: it is run again by DOP853 of the crate `differential-equations`, with its own
//! right-hand side and its own finding of events, and by the solver itself with its events located ten times closer.
//! Both must agree to 1e-8 of the peaks of the run.
//!
//! ```
//! use driveline_solver::plant::train::{Coordinate, Link, Source, Train};
//! use driveline_solver::plant::train::converge::{Recording, prove};
//! let drive = Train::new()
//!     .coordinate(Coordinate::new(1.2).source(Source::Constant(200.0)))
//!     .coordinate(Coordinate::new(0.35).source(Source::Constant(-120.0)))
//!     .link(Link::shaft(0, 1, 850.0).damping(0.5).gap(0.06))
//!     .build()?;
//! let mut run = Recording::new(drive);
//! for _ in 0..500 {
//!     run.advance(1e-3);
//! }
//! let proof = prove(&run)?;
//! assert!(proof.integrator.largest <= 1e-8 && proof.tightened.largest <= 1e-8);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod textbook;

pub use crate::plant::converge::{BOUND, Deviation, NotProven, Proof};

use super::motion::Motion;
use super::signal::Signal;
use crate::plant::converge::pass::{Pass, REACH};
use textbook::Double;

#[derive(Debug, Clone, Copy, PartialEq)]
enum Step {
    Advance(f64),
    Torque(usize, f64),
}

/// A motion whose run is written down as it goes.
#[derive(Debug, Clone)]
pub struct Recording {
    start: Motion,
    steps: Vec<Step>,
    samples: Vec<Vec<f64>>,
    times: Vec<f64>,
    motion: Motion,
}

impl Recording {
    /// Begins with the motion as it is, which must not have been advanced yet.
    #[must_use]
    pub fn new(motion: Motion) -> Self {
        let mut start = motion.clone();
        start.watches.clear();
        Self { start, steps: Vec::new(), samples: Vec::new(), times: Vec::new(), motion }
    }

    /// [`Motion::advance`], written down.
    pub fn advance(&mut self, dt: f64) {
        let refused = self.motion.refused();
        self.motion.advance(dt);
        if self.motion.refused() == refused {
            self.steps.push(Step::Advance(dt));
            self.samples.push(sample(&self.motion));
            self.times.push(self.motion.time());
        }
    }

    /// [`Motion::set_torque`], written down.
    pub fn set_torque(&mut self, coordinate: usize, torque: f64) {
        let refused = self.motion.refused();
        self.motion.set_torque(coordinate, torque);
        if self.motion.refused() == refused {
            self.steps.push(Step::Torque(coordinate, torque));
        }
    }

    /// The motion as it stands.
    #[must_use]
    pub fn motion(&self) -> &Motion {
        &self.motion
    }
}

/// Runs both checks.
///
/// # Errors
/// [`NotProven`] if one of them comes out more than [`BOUND`] from the recording, or cannot be done.
pub fn prove(run: &Recording) -> Result<Proof, NotProven> {
    prove_telling(run, |_| {})
}

/// [`prove`], telling now and then the share of the work that is done, from 0 to 1.
///
/// # Errors
/// As [`prove`].
pub fn prove_telling(run: &Recording, mut done: impl FnMut(f64)) -> Result<Proof, NotProven> {
    if run.samples.is_empty() {
        return Err(NotProven::Empty);
    }
    // the other integrator has some ten times the work of the solver
    let integrator = deviation(run, &again(run, |share| done(0.9 * share))?);
    let tightened = deviation(run, &tightened(run, |share| done(0.9 + 0.1 * share)));
    let checks =
        [("the second integrator", integrator), ("the solver with events located ten times closer", tightened)];
    for (from, Deviation { largest, time }) in checks {
        if largest > BOUND {
            return Err(NotProven::Deviates { from, found: largest, time });
        }
    }
    Ok(Proof { integrator, tightened })
}

fn tightened(run: &Recording, mut done: impl FnMut(f64)) -> Vec<Vec<f64>> {
    let mut motion = run.start.clone();
    motion.set_event_tolerance(0.1 * motion.event_tolerance);
    let mut samples = Vec::new();
    for (index, step) in run.steps.iter().enumerate() {
        done(index as f64 / run.steps.len() as f64);
        match *step {
            Step::Advance(dt) => {
                motion.advance(dt);
                samples.push(sample(&motion));
            }
            Step::Torque(coordinate, torque) => motion.set_torque(coordinate, torque),
        }
    }
    samples
}

/// Speeds, then elongations, then forces, then angles.
fn sample(motion: &Motion) -> Vec<f64> {
    let forces: Vec<Signal> = (0..motion.links()).map(Signal::Force).collect();
    let state = &motion.state;
    let moved = state.speed.iter().chain(&state.elongation).copied();
    moved.chain(motion.read_all(&forces)).chain(state.angle.iter().copied()).collect()
}

fn again(run: &Recording, mut done: impl FnMut(f64)) -> Result<Vec<Vec<f64>>, NotProven> {
    let motion = &run.start;
    let (n, links) = (motion.coordinates(), motion.links());
    let mut y: Vec<f64> =
        motion.state.elongation.iter().chain(&motion.state.speed).chain(&motion.state.angle).copied().collect();
    let peaks = peaks(run);
    let or_one = |size: f64| if size > 0.0 { size } else { 1.0 };
    let stretch = (0..links).map(|l| or_one(peaks[n + l]));
    let scale = stretch.chain((0..n).map(|j| or_one(peaks[j]))).chain((0..n).map(|j| or_one(peaks[n + 2 * links + j])));
    let rate = motion.rate.max(1e-3);
    let pass = Pass { scale: scale.collect(), longest: REACH / rate, close: 0.1 * motion.event_tolerance };
    let mut double = Double::new(&motion.train, motion.held.clone(), &motion.mode.arcs);
    let mut samples = Vec::new();
    let (mut now, mut fresh) = (motion.now, true);
    for (index, step) in run.steps.iter().enumerate() {
        done(index as f64 / run.steps.len() as f64);
        match *step {
            Step::Torque(coordinate, torque) => double.held[coordinate] = torque,
            Step::Advance(dt) => {
                // the clock of the run, which does not gather the rounding of its ticks: teeth that meet 1e-12 s late
                // show
                let end = run.times[samples.len()];
                if std::mem::take(&mut fresh) {
                    double.settle(now, &y);
                }
                while let Some(corner) = motion.corner_after(now).filter(|&corner| corner < end) {
                    double.middle = 0.5 * (now + corner);
                    pass.between(&mut double, &mut y, now, corner)?;
                    now = corner;
                }
                let after = motion.corner_after(now).map_or(end, |corner| corner.min(end));
                double.middle = 0.5 * (now + after);
                pass.between(&mut double, &mut y, now, end)?;
                now = end;
                let next = motion.corner_after(now).unwrap_or(now + dt);
                double.middle = 0.5 * (now + next);
                let forces: Vec<f64> = (0..links).map(|l| double.carried(now, &y, l)).collect();
                let (stretched, rest) = y.split_at(links);
                let (speeds, angles) = rest.split_at(n);
                let all = speeds.iter().chain(stretched).chain(&forces).chain(angles);
                samples.push(all.copied().collect());
            }
        }
    }
    Ok(samples)
}

fn peaks(run: &Recording) -> Vec<f64> {
    let mut peaks = vec![0.0_f64; run.samples.first().map_or(0, Vec::len)];
    for sample in &run.samples {
        for (peak, value) in peaks.iter_mut().zip(sample) {
            *peak = peak.max(value.abs());
        }
    }
    peaks
}

/// Deviation as a share of the peak of each quantity. Where a sample falls on a corner of a torque or a switch of
/// stiffness, forces have two values and are left out of it.
fn deviation(run: &Recording, other: &[Vec<f64>]) -> Deviation {
    let peaks = peaks(run);
    let mut worst = Deviation { largest: 0.0, time: 0.0 };
    let forces = run.start.coordinates() + run.start.links()..run.start.coordinates() + 2 * run.start.links();
    let mut before = run.start.now;
    for ((ours, theirs), &time) in run.samples.iter().zip(other).zip(&run.times) {
        let close = 1e-9 * (time - before);
        let on_corner = run.start.corner_after(time - close).is_some_and(|corner| corner <= time + close);
        before = time;
        for (i, ((a, b), peak)) in ours.iter().zip(theirs).zip(&peaks).enumerate() {
            if on_corner && forces.contains(&i) {
                continue;
            }
            let share = (a - b).abs() / if *peak > 0.0 { *peak } else { 1.0 };
            // a value that is not a number agrees with nothing
            let largest = if share.is_nan() { f64::INFINITY } else { share };
            if largest > worst.largest {
                worst = Deviation { largest, time };
            }
        }
    }
    worst
}
