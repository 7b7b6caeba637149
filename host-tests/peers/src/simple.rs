//! What a drive has where nobody has designed an observer.

use driveline_firmware::scene::{Input, Output};

use crate::model::{Peer, Replayed};
use crate::scene::Scene;

/// Disturbance observer of first order [Ohnishi 1987, Trans. IEE Japan D 107(1)]: what the motor's torque lacks to its
/// acceleration, through a low-pass, is the shaft's torque. The load speed is the motor's through the same low-pass.
#[derive(Clone, Copy, Debug)]
pub struct DisturbanceObserver {
    /// Ticks a second, the corner's share of a tick, g J.
    constants: [f32; 3],
    filtered: f32,
    speed: f32,
    shaft: f32,
}

impl DisturbanceObserver {
    /// With a corner (rad/s).
    pub fn new(scene: &Scene, corner: f32) -> Self {
        let share = corner * scene.period() as f32 / (1.0 + corner * scene.period() as f32);
        // a steady acceleration is answered in full: share/(1 - share) of this low-pass is corner times period
        let momentum = corner * scene.two_mass.motor_inertia as f32;
        DisturbanceObserver {
            constants: [scene.rate_hz as f32, share, momentum],
            filtered: 0.0,
            speed: 0.0,
            shaft: 0.0,
        }
    }
}

impl Peer for DisturbanceObserver {
    fn start(&mut self, torque: f32) {
        (self.filtered, self.speed, self.shaft) = (torque, 0.0, torque);
    }

    #[inline(always)]
    fn step(&mut self, turn: f32, torque: f32, _deadband: f32) {
        let [rate, share, momentum] = self.constants;
        let speed = turn * rate;
        self.filtered += share * (torque + momentum * speed - self.filtered);
        self.shaft = self.filtered - momentum * speed;
        self.speed += share * (speed - self.speed);
    }

    #[inline(always)]
    fn estimate(&self) -> [f32; 3] {
        [self.shaft, self.speed, self.speed]
    }
}

/// The speed differenced and low-passed, the shaft torque from its difference: torque less `J` times acceleration.
#[derive(Clone, Copy, Debug)]
pub struct DifferenceLowPass {
    /// Ticks a second, the corner's share of a tick, motor's inertia over the period.
    constants: [f32; 3],
    speed: f32,
    shaft: f32,
}

impl DifferenceLowPass {
    /// With a corner (rad/s).
    pub fn new(scene: &Scene, corner: f32) -> Self {
        let share = corner * scene.period() as f32 / (1.0 + corner * scene.period() as f32);
        let inertia = scene.rate_hz as f32 * scene.two_mass.motor_inertia as f32;
        DifferenceLowPass { constants: [scene.rate_hz as f32, share, inertia], speed: 0.0, shaft: 0.0 }
    }
}

impl Peer for DifferenceLowPass {
    fn start(&mut self, torque: f32) {
        (self.speed, self.shaft) = (0.0, torque);
    }

    #[inline(always)]
    fn step(&mut self, turn: f32, torque: f32, _deadband: f32) {
        let [rate, share, inertia] = self.constants;
        let rise = share * (turn * rate - self.speed);
        self.speed += rise;
        self.shaft = torque - inertia * rise;
    }

    #[inline(always)]
    fn estimate(&self) -> [f32; 3] {
        [self.shaft, self.speed, self.speed]
    }
}

/// Nothing: what the frame round an observer costs.
#[derive(Clone, Copy, Debug)]
pub struct Nothing;

impl Replayed for Nothing {
    fn start(&mut self, _: &Input) {}

    #[inline(always)]
    fn tick(&mut self, _: &Input, _: &mut Output) {}
}
