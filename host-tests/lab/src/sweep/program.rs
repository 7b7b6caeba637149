//! How long and how hard a place is run, and what its errors are relative to.

use driveline::machine::TwoMass as Machine;
use driveline::settings::Bases;

use super::grid::{PERIOD, Place};
use super::load::{LOAD_TORQUE, Torques};
use super::reference::{Reference, Truth};

/// How long and how hard a place is run.
#[derive(Clone, Copy, Debug)]
pub struct Course {
    /// Ticks that a torque is held for.
    pub hold: u64,
    /// Ticks of the run.
    pub ticks: u64,
    /// Largest motor or load speed over the largest slip.
    pub rigid: f64,
    torque: f64,
    speed: f64,
    shaft_torque: f64,
    size: f64,
}

impl Course {
    /// Four periods of the natural frequency, but from 2000 ticks to `longest`; each torque is held for a period.
    pub fn new(place: &Place, longest: u64) -> Self {
        let period = place.ticks_in_a_period();
        let ticks = (4 * period).clamp(2000.min(longest), longest);
        let hold = period.min(ticks / 4);
        let mut reference = Reference::new(place, LOAD_TORQUE);
        let mut torques = Torques::new(hold);
        let mut course = Course { hold, ticks, torque: 0.75, speed: 0.0, shaft_torque: 0.0, size: 0.0, rigid: 0.0 };
        let mut slip: f64 = 0.0;
        for _ in 0..ticks {
            reference.tick(torques.next());
            let state = reference.state();
            course.speed = course.speed.max(state.motor_speed.abs()).max(state.load_speed.abs());
            course.shaft_torque = course.shaft_torque.max(state.shaft_torque.abs());
            course.size = course.size.max(state.size);
            slip = slip.max((state.motor_speed - state.load_speed).abs());
        }
        course.torque = course.torque.max(course.shaft_torque);
        course.rigid = course.speed / slip;
        course
    }

    /// Bases that the run fits in, a power of two for the torque so that every torque is held exactly, and no smaller a
    /// speed than the torque would reach in two ticks with this inertia: fixed point holds no coefficient above 1/2.
    ///
    /// `slip` (rad/s) is a lower bound of the speed's base.
    pub fn bases(&self, machine: &Machine, inertia: f64, slip: f64) -> Bases {
        let torque = self.torque_base();
        let speed = (1.1 * self.speed).max(2.1 * PERIOD * torque / inertia).max(slip);
        Bases::new(machine, torque, speed)
    }

    /// Base of the torque (N m).
    pub fn torque_base(&self) -> f64 {
        (1.1 * self.torque).log2().ceil().exp2()
    }

    /// A unit of the bases in what errors are relative to.
    pub fn coarseness(&self, machine: &Machine, bases: &Bases) -> f64 {
        let speed = bases.speed * machine.total_inertia().sqrt() / self.size;
        (bases.torque / self.shaft_torque).max(speed)
    }

    /// The error of a state, motor speed, shaft torque and load speed: of the speeds in the energy norm, of the run's
    /// largest energy, or of the shaft torque, of its peak, whichever is larger.
    pub fn error(&self, machine: &Machine, truth: &Truth, [motor_speed, shaft_torque, load_speed]: [f64; 3]) -> f64 {
        let (motor, load) = (motor_speed - truth.motor_speed, load_speed - truth.load_speed);
        let speeds = (machine.motor_inertia * motor * motor + machine.load_inertia * load * load).sqrt() / self.size;
        let torque = (shaft_torque - truth.shaft_torque).abs() / self.shaft_torque;
        // A NaN is an error without bound.
        if speeds.is_nan() || torque.is_nan() { f64::INFINITY } else { speeds.max(torque) }
    }
}
