//! The signals that an observer gets, and the model of two masses in `f32`.

use driveline::design::TwoMassDesign;
use driveline_firmware::scene::{Input, Output};

use crate::scene::Scene;

/// An observer on a recording: words of its own number in and out, as a scene has them.
pub trait Replayed {
    /// Begins at a standstill, at an angle, with a shaft that carries the torque.
    fn start(&mut self, input: &Input);

    /// Takes angle and torque of a tick; gives shaft torque and load speed.
    fn tick(&mut self, input: &Input, output: &mut Output);
}

/// An observer in `f32`.
pub trait Peer {
    /// Begins at a standstill with a shaft that carries a torque (N m).
    fn start(&mut self, torque: f32);

    /// Takes the turn of the motor in a tick (rad) and the torque during it (N m). An innovation of at most `deadband`
    /// (rad) is left out; below zero none is.
    fn step(&mut self, turn: f32, torque: f32, deadband: f32);

    /// Shaft torque (N m), load speed and motor speed (rad/s).
    fn estimate(&self) -> [f32; 3];
}

/// A peer behind a gear, whose losses are deducted as the library's `GearedObserver` does; without losses the peer
/// alone.
#[derive(Clone, Copy, Debug)]
pub struct Behind<P> {
    peer: P,
    angle: u32,
    friction: f32,
    /// What is left of the torque that the peer finds, behind the gear.
    left: f32,
    stiction_gain: f32,
    deadband: f32,
}

impl<P> Behind<P> {
    /// A peer at rest at angle zero.
    pub fn new(scene: &Scene, peer: P) -> Self {
        let [friction, left, stiction_gain, deadband] = match scene.gear {
            None => [0.0, 1.0, 0.0, 0.0],
            Some(gear) => {
                let square = gear.efficiency * gear.efficiency;
                let left = 2.0 * gear.efficiency / (1.0 + square);
                [(1.0 - square) / (1.0 + square), left, 0.5 * gear.inertia / scene.period(), gear.deadband]
            }
        };
        Behind {
            peer,
            angle: 0,
            friction: friction as f32,
            left: left as f32,
            stiction_gain: stiction_gain as f32,
            deadband: deadband as f32,
        }
    }
}

impl<P: Peer> Replayed for Behind<P> {
    fn start(&mut self, input: &Input) {
        self.angle = input.angle;
        self.peer.start(f32::from_bits(input.torque));
    }

    #[inline(always)]
    fn tick(&mut self, input: &Input, output: &mut Output) {
        const TURN: f32 = core::f32::consts::TAU / 4_294_967_296.0;
        let turn = input.angle.wrapping_sub(self.angle) as i32 as f32 * TURN;
        self.angle = input.angle;
        let mut torque = f32::from_bits(input.torque);
        let mut deadband = -1.0;
        if self.friction > 0.0 {
            let [shaft, _, motor] = self.peer.estimate();
            let limit = (self.friction * shaft).abs();
            let holding = torque - shaft + self.stiction_gain * motor;
            let friction = if holding > limit {
                limit
            } else if holding < -limit {
                -limit
            } else {
                deadband = self.deadband;
                holding
            };
            torque -= friction;
        }
        self.peer.step(turn, torque, deadband);
        let [shaft, load, _] = self.peer.estimate();
        output.shaft_torque = (self.left * shaft).to_bits();
        output.load_speed = load.to_bits();
    }
}

/// Two masses and the load torque: `[motor angle from the last measured one, motor speed, twist, load speed, load
/// torque]`.
#[derive(Clone, Copy, Debug)]
pub struct Model {
    /// Transition of a tick.
    pub transition: [[f32; 5]; 5],
    /// Effect of the motor's torque.
    pub input: [f32; 5],
    /// Gains of the library's design.
    pub gains: [f32; 5],
    /// Noise of the states in a tick.
    pub noise: [[f32; 5]; 5],
    /// Variance of the angle (rad2).
    pub measurement: f32,
    /// Covariance at the start.
    pub covariance: [[f32; 5]; 5],
    /// Stiffness and damping of the shaft.
    pub shaft: [f32; 2],
}

impl Model {
    /// Of a scene, with its design; none of a shaft that no observer can follow at the scene's rate.
    pub fn of(scene: &Scene) -> Option<(Self, TwoMassDesign)> {
        let design = scene.design?;
        let torque = scene.disturbance.torque_variance().ok()?;
        let mut noise = [[0.0; 5]; 5];
        for (row, own) in noise.iter_mut().zip(design.input) {
            *row = design.input.map(|other| (own * other * torque) as f32);
        }
        noise[4][4] += scene.disturbance.load_torque_variance(scene.period()).ok()? as f32;
        let single = |rows: [[f64; 5]; 5]| rows.map(|row| row.map(|value| value as f32));
        let model = Model {
            transition: single(design.transition.0),
            input: design.input.map(|value| value as f32),
            gains: design.gains.map(|value| value as f32),
            noise,
            measurement: scene.encoder.variance().ok()? as f32,
            covariance: single(design.posterior.0),
            shaft: [scene.two_mass.stiffness as f32, scene.two_mass.damping as f32],
        };
        Some((model, design))
    }
}

/// A state at a standstill with a shaft that carries a torque.
pub fn at_rest([stiffness, _]: [f32; 2], torque: f32) -> [f32; 5] {
    [0.0, 0.0, torque / stiffness, 0.0, torque]
}

/// Shaft torque, load speed and motor speed of a state.
#[inline(always)]
pub fn estimate([stiffness, damping]: [f32; 2], motor_speed: f32, twist: f32, load_speed: f32) -> [f32; 3] {
    [stiffness * twist + damping * (motor_speed - load_speed), load_speed, motor_speed]
}
