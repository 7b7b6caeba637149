//! Proof that a recorded run has converged: the run is done again by other means and must come out the same.
//!
//! Two checks, each to 1e-8 of the peaks of the run:
//! - a second integrator (DOP853 of the crate `differential-equations`), with its own right-hand side, its own
//!   finding of events by re-integration, and no exponential;
//! - the solver itself with its events located ten times closer.
//!
//! ```
//! use driveline_solver::plant::{Chain, Shaft};
//! use driveline_solver::plant::converge::{Recording, prove};
//! let drive = Chain::motor(1.2).shaft(Shaft::elastic(850.0).damping(0.5).gap(0.06), 0.35).load(120.0).build()?;
//! let mut run = Recording::new(drive);
//! for _ in 0..500 {
//!     run.advance(200.0, 1e-3);
//! }
//! let proof = prove(&run)?;
//! assert!(proof.integrator.largest <= 1e-8 && proof.tightened.largest <= 1e-8);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod crossing;
pub(super) mod pass;
mod recording;
mod rerun;
mod textbook;

pub use recording::Recording;

use super::solver::Plant;
use recording::Step;

/// Largest deviation that a reference run may show, as a share of the peak.
pub const BOUND: f64 = 1e-8;

/// A deviation between two runs, as a share of the peak of its quantity over the run (of all speeds, of each shaft's
/// torque).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deviation {
    /// The largest over all ticks and quantities.
    pub largest: f64,
    /// Where it was found, s.
    pub time: f64,
}

/// What the two checks found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Proof {
    /// Against the second integrator.
    pub integrator: Deviation,
    /// Against the solver with its events located ten times closer.
    pub tightened: Deviation,
}

/// Why a run does not stand.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NotProven {
    /// A check came out otherwise.
    #[error("the run deviates by {found:.1e} of peak from {from} at {time} s: expected at most {BOUND:.0e}")]
    Deviates {
        /// Which check.
        from: &'static str,
        /// The deviation over the peak.
        found: f64,
        /// Where, s.
        time: f64,
    },
    /// The second integrator gave up.
    #[error("the second integrator failed at {time} s: {reason}")]
    Integrator {
        /// Where, s.
        time: f64,
        /// What it said.
        reason: String,
    },
    /// Nothing was recorded.
    #[error("the recording holds no tick")]
    Empty,
}

/// Runs both checks.
///
/// # Errors
/// [`NotProven`] if one of them comes out more than [`BOUND`] from the recording, or cannot be done.
pub fn prove(run: &Recording) -> Result<Proof, NotProven> {
    let integrator = deviation(run, &rerun::rerun(run)?)?;
    let tightened = deviation(run, &tightened(run))?;
    let checks =
        [("the second integrator", integrator), ("the solver with events located ten times closer", tightened)];
    for (from, Deviation { largest, time }) in checks {
        if largest > BOUND {
            return Err(NotProven::Deviates { from, found: largest, time });
        }
    }
    Ok(Proof { integrator, tightened })
}

fn tightened(run: &Recording) -> Vec<Vec<f64>> {
    let mut plant = run.start.clone();
    plant.set_event_tolerance(0.1 * plant.event_tolerance);
    let mut samples = Vec::new();
    for step in &run.steps {
        match *step {
            Step::Advance { torque, dt } => {
                plant.advance(torque, dt);
                samples.push(sample(&plant));
            }
            Step::Load { node, torque } => plant.set_load_torque(node, torque),
            Step::Brake { node, torque } => plant.set_brake(node, torque),
        }
    }
    samples
}

/// Speeds, then shaft torques, then the motor's angle.
fn sample(plant: &Plant) -> Vec<f64> {
    let speeds = (0..plant.nodes()).map(|j| plant.speed(j));
    let torques = (0..plant.nodes() - 1).map(|s| plant.shaft_torque(s));
    speeds.chain(torques).chain([plant.motor_angle()]).collect()
}

fn deviation(run: &Recording, other: &[Vec<f64>]) -> Result<Deviation, NotProven> {
    let n = run.start.nodes();
    let first = run.samples.first().ok_or(NotProven::Empty)?;
    let mut peaks = vec![0.0_f64; first.len()];
    for sample in &run.samples {
        for (peak, value) in peaks.iter_mut().zip(sample) {
            *peak = peak.max(value.abs());
        }
    }
    let top_speed = peaks[..n].iter().copied().fold(0.0, f64::max);
    peaks[..n].fill(top_speed);
    let mut worst = Deviation { largest: 0.0, time: 0.0 };
    for ((ours, theirs), &time) in run.samples.iter().zip(other).zip(&run.times) {
        for ((a, b), peak) in ours.iter().zip(theirs).zip(&peaks) {
            let share = (a - b).abs() / if *peak > 0.0 { *peak } else { 1.0 };
            // what is not a number agrees with nothing
            let largest = if share.is_nan() { f64::INFINITY } else { share };
            if largest > worst.largest {
                worst = Deviation { largest, time };
            }
        }
    }
    Ok(worst)
}
