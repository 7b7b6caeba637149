//! Proof that a run has converged: it is done again by another integrator and must come out the same.
//!
//! The second integrator is DOP853 of the crate `differential-equations`, with its own right-hand side: forces and
//! gyroscopic terms of the instant, no exponential, no grid of speeds, no interpolation.

use differential_equations::ode::{ODE, OrdinaryNumericalMethod};
use differential_equations::prelude::ExplicitRungeKutta;
use nalgebra::{Complex, DVector};

use super::modal::Modal;
use super::spin::Turn;
use super::whirl::Whirl;

/// Largest deviation that a run may show, as a share of the peak of the state.
pub const BOUND: f64 = 1e-8;

/// Relative tolerance of the second integrator.
const TOLERANCE: f64 = 1e-12;

/// A rotor whose run is written down as it goes.
#[derive(Clone, Debug)]
pub struct Recording {
    start: DVector<f64>,
    whirl: Whirl,
    steps: Vec<(Turn, Vec<Complex<f64>>)>,
    states: Vec<DVector<f64>>,
}

impl Recording {
    /// Begins with the rotor as it is.
    #[must_use]
    pub fn new(whirl: Whirl) -> Self {
        Recording { start: whirl.state().clone(), whirl, steps: Vec::new(), states: Vec::new() }
    }

    /// [`Whirl::advance`], written down.
    pub fn advance(&mut self, turn: &Turn) {
        self.whirl.advance(turn);
        self.steps.push((*turn, self.whirl.unbalance().to_vec()));
        self.states.push(self.whirl.state().clone());
    }

    /// The rotor as it stands.
    pub fn whirl(&mut self) -> &mut Whirl {
        &mut self.whirl
    }
}

/// Why a run does not stand.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NotProven {
    /// The second integrator came out otherwise.
    #[error(
        "the run deviates by {found:.1e} of peak from the second integrator at tick {tick}: expected at most \
            {BOUND:.0e}"
    )]
    Deviates {
        /// The deviation over the peak.
        found: f64,
        /// Where.
        tick: usize,
    },
    /// The second integrator gave up.
    #[error("the second integrator failed at tick {tick}: {reason}")]
    Integrator {
        /// Where.
        tick: usize,
        /// Its output.
        reason: String,
    },
    /// Nothing was recorded.
    #[error("the recording holds no tick")]
    Empty,
}

/// Runs the recording again and gives the largest deviation as a share of the peak of all displacements and of all
/// rates.
///
/// # Errors
/// [`NotProven`] if it comes out more than [`BOUND`] away, or cannot be done.
pub fn prove(run: &Recording) -> Result<f64, NotProven> {
    let modal = run.whirl.modal();
    let peak = run.states.iter().map(|state| state.amax()).fold(0.0, f64::max);
    if run.states.is_empty() {
        return Err(NotProven::Empty);
    }
    let scale = if peak > 0.0 { peak } else { 1.0 };
    let mut z: Vec<f64> = run.start.iter().map(|v| v / scale).collect();
    let (mut worst, mut at, mut step) = (0.0_f64, 0, 0.0);
    for (tick, ((turn, unbalance), state)) in run.steps.iter().zip(&run.states).enumerate() {
        let equations = Equations { modal, turn, unbalance, scale };
        let failed = |reason: String| NotProven::Integrator { tick, reason };
        let mut method = ExplicitRungeKutta::dop853().rtol(TOLERANCE).atol(TOLERANCE);
        method = method.h0(if step > 0.0 { f64::min(step, turn.duration) } else { turn.duration });
        method.init(&equations, 0.0, turn.duration, &z).map_err(|e| failed(format!("{e:?}")))?;
        while turn.duration - method.t() > 1e-14 * turn.duration {
            let left = turn.duration - method.t();
            let h = method.h().min(left);
            method.set_h(h);
            method.step(&equations).map_err(|e| failed(format!("{e:?}")))?;
            step = method.h();
        }
        z.clone_from(method.y());
        for (ours, theirs) in state.iter().zip(&z) {
            let share = (ours / scale - theirs).abs();
            // a value that is not a number agrees with nothing
            let share = if share.is_nan() { f64::INFINITY } else { share };
            if share > worst {
                (worst, at) = (share, tick);
            }
        }
    }
    if worst > BOUND { Err(NotProven::Deviates { found: worst, tick: at }) } else { Ok(worst) }
}

/// The modal equations within one tick, in multiples of the peak.
struct Equations<'a> {
    modal: &'a Modal,
    turn: &'a Turn,
    unbalance: &'a [Complex<f64>],
    scale: f64,
}

impl ODE<f64, Vec<f64>> for Equations<'_> {
    fn diff(&self, t: f64, z: &Vec<f64>, dz: &mut Vec<f64>) {
        let Modal { frequency, damping, gyroscopic, circulatory, stations, .. } = self.modal;
        let r = frequency.len();
        let (angle, speed, rate) = self.turn.at(t / self.turn.duration);
        let (stretch, rates) = z.split_at(r);
        for i in 0..r {
            dz[i] = frequency[i] * rates[i];
            let mut sum = -frequency[i] * stretch[i];
            for j in 0..r {
                sum -= circulatory[(i, j)] * stretch[j] / frequency[j];
                sum -= (damping[(i, j)] + speed * gyroscopic[(i, j)]) * rates[j];
            }
            for (u, axes) in self.unbalance.iter().zip(stations) {
                // the mass centre's own acceleration, by hand
                let (sine, cosine) = (angle + u.arg()).sin_cos();
                let (across, along) = (rate * u.norm(), speed * speed * u.norm());
                sum += axes[0][i] * (along * cosine + across * sine) / self.scale;
                sum += axes[1][i] * (along * sine - across * cosine) / self.scale;
            }
            dz[r + i] = sum;
        }
    }
}
