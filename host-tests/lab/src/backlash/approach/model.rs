//! The two masses as the approaches have them: `[motor angle, motor speed, twist, load speed, load torque]`.

use core::f64::consts::TAU;

use driveline::design::ExactStep;
use driveline::machine::TwoMass;
use nalgebra::{SMatrix, SVector};

use crate::backlash::case::{Case, RATE_HZ};

/// A state.
pub type State = SVector<f64, 5>;
/// A matrix of states.
pub type Square = SMatrix<f64, 5, 5>;

/// Machine, gap, and noise of a tick.
#[derive(Clone, Copy, Debug)]
pub struct Model {
    /// The machine.
    pub machine: TwoMass,
    /// Half the gap (rad).
    pub half_gap: f64,
    /// Steps in contact and in free flight, with what the motor's torque does.
    pub contact: (Square, State),
    /// As [`contact`](Self::contact), without a shaft.
    pub free: (Square, State),
    /// Variance of the motor's torque in a tick, and what the load's gains in one (N2 m2).
    pub noise: [f64; 2],
    /// Angle of a count of the encoder (rad).
    pub count: f64,
}

impl Model {
    /// Of a case.
    pub fn new(case: &Case) -> Self {
        let machine = case.machine;
        let loose = TwoMass { stiffness: 0.0, damping: 0.0, ..machine };
        let period = 1.0 / f64::from(RATE_HZ);
        let disturbance = case.disturbance();
        let noise = [
            disturbance.torque_accuracy * disturbance.torque_accuracy,
            disturbance.load_torque_step * disturbance.load_torque_step * period / disturbance.within,
        ];
        Model {
            machine,
            half_gap: 0.5 * machine.gap,
            contact: linear(&machine, period),
            free: linear(&loose, period),
            noise,
            count: TAU / f64::from(4 * case.lines),
        }
    }

    /// Variance of an angle rounded to a count (rad2).
    pub fn measurement(&self) -> f64 {
        self.count * self.count / 12.0
    }

    /// Twist beyond the gap.
    pub fn stretch(&self, twist: f64) -> f64 {
        twist - twist.clamp(-self.half_gap, self.half_gap)
    }

    /// The state after a tick under the law that the tick begins with. (At 10 kHz and 15 Hz a tick of the wrong law
    /// costs 1e-4 of the peak.)
    pub fn step(&self, state: &State, torque: f64) -> State {
        if self.stretch(state[2]) == 0.0 {
            self.free.0 * state + self.free.1 * torque
        } else {
            self.side(state, torque, self.half_gap * state[2].signum())
        }
    }

    /// The state after a tick in contact with the flank at this twist.
    pub fn side(&self, state: &State, torque: f64, flank: f64) -> State {
        let mut shifted = *state;
        shifted[2] -= flank;
        let mut next = self.contact.0 * shifted + self.contact.1 * torque;
        next[2] += flank;
        next
    }

    /// Shaft torque and load speed of a state in contact at this twist.
    pub fn taut(&self, state: &State, flank: f64) -> [f64; 2] {
        let torque = self.machine.stiffness * (state[2] - flank) + self.machine.damping * (state[1] - state[3]);
        [torque, state[3]]
    }

    /// Shaft torque and load speed of a state.
    pub fn estimate(&self, state: &State) -> [f64; 2] {
        if self.stretch(state[2]) == 0.0 {
            [0.0, state[3]]
        } else {
            self.taut(state, self.half_gap * state[2].signum())
        }
    }
}

/// Transition and input of a machine, column by column of its exact step.
fn linear(machine: &TwoMass, period: f64) -> (Square, State) {
    let step = ExactStep::new(machine, period);
    let (motor, load, total) = (machine.motor_inertia, machine.load_inertia, machine.total_inertia());
    let moved = |state: &State, torque: f64| {
        let [angle, motor_speed, twist, load_speed, load_torque] = (*state).into();
        let (mean, slip) = ((motor * motor_speed + load * load_speed) / total, motor_speed - load_speed);
        let drive = torque / motor + load_torque / load;
        let mean_after = mean + period * (torque - load_torque) / total;
        let twisted = step.n11 * twist + step.n12 * slip + step.g1 * drive;
        let slip_after = slip + step.n21 * twist + step.n22 * slip + step.g2 * drive;
        State::from([
            angle + 0.5 * period * (mean + mean_after) + load / total * twisted,
            mean_after + load / total * slip_after,
            twist + twisted,
            mean_after - motor / total * slip_after,
            load_torque,
        ])
    };
    let mut transition = Square::zeros();
    for column in 0..5 {
        transition.set_column(column, &moved(&Square::identity().column(column).into_owned(), 0.0));
    }
    (transition, moved(&State::zeros(), 1.0))
}

/// An encoder's angle without its wraps (rad), from the middle of its counts.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unwrapped {
    last: u32,
    angle: f64,
}

impl Unwrapped {
    /// Takes an angle of 2^32 to the turn.
    pub fn take(&mut self, angle: u32) -> f64 {
        self.angle += f64::from(angle.wrapping_sub(self.last) as i32) * (TAU / 4_294_967_296.0);
        self.last = angle;
        self.angle
    }
}
