//! A rotor that runs in time.

use nalgebra::{Complex, DVector, RowDVector};

use super::error::RotorError;
use super::modal::Modal;
use super::spin::Turn;
use super::stepping::{INSTANTS, Steps, force_per_unbalance};

/// Displacement, velocity and acceleration at a sensor [m, m/s, m/s2].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Displacement (m).
    pub displacement: f64,
    /// Velocity (m/s).
    pub velocity: f64,
    /// Acceleration (m/s2).
    pub acceleration: f64,
}

/// A rotor at rest at first, propagated tick by tick as its shaft turns.
///
/// All ticks have one duration. Exact at a constant speed but for the force, a cubic through four instants of the tick;
/// at a changing one of the fourth order in the tick. [`super::converge::prove`] says how good that is for a run.
#[derive(Clone, Debug)]
pub struct Whirl {
    steps: Steps,
    state: DVector<f64>,
    unbalance: Vec<Complex<f64>>,
    /// The force at the end of the last tick, along `x` and `y` of each station.
    force: DVector<f64>,
    speed: f64,
}

impl Whirl {
    /// A rotor at rest with ticks of a duration (s) and no unbalance.
    #[must_use]
    pub fn new(modal: Modal, tick: f64) -> Self {
        Self::with_spacing(modal, tick, None)
    }

    /// The same with a grid of speeds of this spacing (rad/s), see the module's text.
    pub(super) fn with_spacing(modal: Modal, tick: f64, spacing: Option<f64>) -> Self {
        let (n, stations) = (2 * modal.count(), modal.stations.len());
        Whirl {
            steps: Steps::new(modal, tick, spacing),
            state: DVector::zeros(n),
            unbalance: vec![Complex::new(0.0, 0.0); stations],
            force: DVector::zeros(2 * stations),
            speed: 0.0,
        }
    }

    /// Sets the unbalance (kg m) of every station, from the next tick on.
    ///
    /// # Errors
    /// Another number of them than of stations.
    pub fn set_unbalance(&mut self, unbalance: &[Complex<f64>]) -> Result<(), RotorError> {
        if unbalance.len() != self.unbalance.len() {
            return Err(RotorError::Count {
                name: "unbalances",
                found: unbalance.len(),
                expected: self.unbalance.len(),
            });
        }
        self.unbalance.copy_from_slice(unbalance);
        Ok(())
    }

    /// The unbalance of every station (kg m).
    #[must_use]
    pub fn unbalance(&self) -> &[Complex<f64>] {
        &self.unbalance
    }

    /// Duration of a tick (s).
    #[must_use]
    pub fn tick(&self) -> f64 {
        self.steps.tick
    }

    /// Runs a tick while the shaft turns so. The turn's duration is taken to be the tick's.
    pub fn advance(&mut self, turn: &Turn) {
        let stations = self.unbalance.len();
        let mut forces = Vec::with_capacity(8 * stations);
        for instant in INSTANTS {
            let per_unbalance = force_per_unbalance(turn.at(instant));
            for &u in &self.unbalance {
                let force = u * per_unbalance;
                forces.extend([force.re, force.im]);
            }
        }
        self.state = self.steps.apply(turn, &self.state, &forces);
        self.force.copy_from_slice(&forces[6 * stations..]);
        self.speed = turn.end_speed;
    }

    /// Puts the rotor into the steady whirl of a constant speed at an angle, as if it had run there for long.
    ///
    /// # Errors
    /// An undamped rotor on a critical speed.
    pub fn settle(&mut self, angle: f64, speed: f64) -> Result<(), RotorError> {
        let modal = self.steps.modal();
        let (a, b) = (modal.system(speed), modal.input());
        let n = a.nrows();
        let square = speed * speed;
        let mut force = DVector::zeros(b.ncols());
        for (station, &u) in self.unbalance.iter().enumerate() {
            force[2 * station] = u * square;
            force[2 * station + 1] = u * Complex::new(0.0, -square);
        }
        let system = a.map(|v| Complex::new(-v, 0.0)) + nalgebra::DMatrix::identity(n, n) * Complex::new(0.0, speed);
        let input = b.map(|v| Complex::new(v, 0.0)) * &force;
        let steady = system.lu().solve(&input).filter(|x| x.iter().all(|v| v.re.is_finite() && v.im.is_finite()));
        let steady = steady.ok_or(RotorError::Unbounded { speed })?;
        let turned = Complex::from_polar(1.0, angle);
        self.state = steady.map(|v| (v * turned).re);
        self.force = force.map(|v| (v * turned).re);
        self.speed = speed;
        Ok(())
    }

    /// Signal of sensor `sensor`; `None` where there is none.
    #[must_use]
    pub fn motion(&self, sensor: usize) -> Option<Motion> {
        let modal = self.steps.modal();
        let row = modal.sensors.get(sensor)?;
        let r = modal.count();
        let deflection = self.state.rows(0, r).component_div(&modal.frequency);
        let rate = self.state.rows(r, r);
        Some(Motion {
            displacement: (row * &deflection)[0],
            velocity: (row * rate)[0],
            acceleration: self.acceleration(row),
        })
    }

    fn acceleration(&self, row: &RowDVector<f64>) -> f64 {
        let modal = self.steps.modal();
        let r = modal.count();
        let stretch = self.state.rows(0, r);
        let rate = self.state.rows(r, r);
        let mut second = -stretch.component_mul(&modal.frequency);
        second -= &modal.circulatory * stretch.component_div(&modal.frequency);
        second -= &modal.damping * rate + &modal.gyroscopic * rate * self.speed;
        for (station, axes) in modal.stations.iter().enumerate() {
            for (axis, shape) in axes.iter().enumerate() {
                second += shape.transpose() * self.force[2 * station + axis];
            }
        }
        (row * second)[0]
    }

    /// The state `(w eta, eta')`.
    pub(super) fn state(&self) -> &DVector<f64> {
        &self.state
    }

    pub(super) fn modal(&self) -> &Modal {
        self.steps.modal()
    }
}
