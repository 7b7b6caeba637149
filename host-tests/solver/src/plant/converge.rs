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
//! assert!(proof.largest() <= 1e-8);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub(super) mod pass;
mod proof;
mod recording;
mod rerun;
mod textbook;

pub use proof::{BOUND, Deviation, NotProven, Proof, Sensitive};
pub use recording::Recording;

use recording::{Step, sample};

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
            return Err(NotProven::Deviates { from, found: largest, expected: BOUND, time });
        }
    }
    Ok(Proof { integrator, tightened: Some(tightened), sensitive: None })
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
            Step::Shaft { shaft, stiffness, damping } => plant.set_shaft(shaft, stiffness, damping),
        }
    }
    samples
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
            // a value that is not a number agrees with nothing
            let largest = if share.is_nan() { f64::INFINITY } else { share };
            if largest > worst.largest {
                worst = Deviation { largest, time };
            }
        }
    }
    Ok(worst)
}
