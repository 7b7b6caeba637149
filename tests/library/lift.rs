//! The hoist's full plant as the tests of scheduling and learning lift with it.

use std::f64::consts::TAU;

use driveline_solver::plant::{Chain, Plant, Shaft, Start};

/// Gravity (m/s2), the standard value of ISO 80000-3.
const GRAVITY: f64 = 9.80665;

/// A load on a rope: the hoist's figures once more, by own arithmetic.
pub struct Lift {
    pub plant: Plant,
    /// Torque of the weight at the motor (N m).
    pub weight: f64,
    /// Stiffness and damping of the rope at the motor.
    rope: [f64; 2],
}

impl Lift {
    /// A load (kg) on a rope (m) at rest, as a brake holds it.
    pub fn new(mass: f64, length: f64) -> Self {
        let travel = 0.8 / (2.0 * 2.0 * 31.5);
        let square = travel * travel;
        let (weight, rope) = (mass * GRAVITY * travel, [2.9e6 * 12.0 / length * square, 3.6e3 * square]);
        let plant = Chain::motor(0.62)
            .shaft(Shaft::elastic(5.0e4).damping(2.0), 0.08)
            .efficiency(0.94)
            .shaft(Shaft::rope(rope[0]).damping(rope[1]), mass * square)
            .load(weight)
            .start(Start::Given { twists: vec![weight / 5.0e4, weight / rope[0]], speeds: vec![0.0; 3] })
            .build()
            .unwrap();
        Lift { plant, weight, rope }
    }

    /// The rope's pull at the motor.
    pub fn pull(&self) -> f64 {
        let [stiffness, damping] = self.rope;
        let rate = self.plant.speed(1) - self.plant.speed(2);
        (stiffness * self.plant.twist(1) + damping * rate).max(0.0)
    }

    /// An incremental encoder of 2048 lines, switched on at the start, with an eccentricity (amplitude and phase (rad))
    /// and a random error (rad).
    pub fn encoder(&self, [amplitude, phase]: [f64; 2], error: f64) -> u32 {
        let angle = self.plant.motor_angle();
        let read = angle + amplitude * ((angle - phase).cos() - phase.cos()) + error;
        let turn = (read / TAU * 8192.0).floor() / 8192.0;
        (turn.rem_euclid(1.0) * 4_294_967_296.0) as u64 as u32
    }
}
