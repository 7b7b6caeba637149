//! The blooming mill rattling through its gap: inputs under which every path of the observer of backlash is taken.
//!
//! Two masses by the semi-implicit step, from an impact on, under a motor torque that changes its sign every 25 ms. It
//! is for counting instructions, not for judging estimates. A test on the host counts how often each path is taken.

use driveline::configure::Machine;
use driveline::machine::TwoMass;

use crate::scenes::blooming_mill::{BloomingMill, GAP};

/// Ticks a second.
pub const RATE_HZ: u32 = 10_000;

const MACHINE: TwoMass = BloomingMill::TWO_MASS;
const STEP: f32 = 1.0 / RATE_HZ as f32;
const MOTOR: f32 = MACHINE.motor_inertia as f32;
const LOAD: f32 = MACHINE.load_inertia as f32;
const STIFFNESS: f32 = MACHINE.stiffness as f32;
const DAMPING: f32 = MACHINE.damping as f32;
const HALF_GAP: f32 = 0.5 * GAP as f32;
/// Drag of the rolls (N m s/rad), which lets the gap open.
const DRAG: f32 = 5.0e4;
/// Torque of the motor (N m): more than rated, for more impacts, and still plausible.
const TORQUE: f32 = 1.6 * BloomingMill::RATING.torque_limit.0 as f32;
/// 2^32 to the turn.
const PER_RADIAN: f32 = 4_294_967_296.0 / core::f32::consts::TAU;

/// The machine.
#[derive(Clone, Debug)]
pub struct Rattle {
    tick: u32,
    angle: u32,
    twist: f32,
    motor_speed: f32,
    load_speed: f32,
}

impl Rattle {
    /// In the middle of the gap, the rolls coming back at 1.5 rad/s.
    pub const fn new() -> Self {
        Rattle { tick: 0, angle: 0, twist: 0.0, motor_speed: 0.0, load_speed: -1.5 }
    }

    /// The angle after the next tick, 2^32 to the turn, and the motor's torque during it (N m).
    pub fn next_input(&mut self) -> (u32, f32) {
        let torque = if (self.tick / 250).is_multiple_of(2) { TORQUE } else { -TORQUE };
        self.tick = self.tick.wrapping_add(1);
        let stretch = if self.twist > HALF_GAP {
            self.twist - HALF_GAP
        } else if self.twist < -HALF_GAP {
            self.twist + HALF_GAP
        } else {
            0.0
        };
        let slip = self.motor_speed - self.load_speed;
        let shaft = if stretch == 0.0 { 0.0 } else { STIFFNESS * stretch + DAMPING * slip };
        self.motor_speed += STEP / MOTOR * (torque - shaft);
        self.load_speed += STEP / LOAD * (shaft - DRAG * self.load_speed);
        self.twist += STEP * (self.motor_speed - self.load_speed);
        self.angle = self.angle.wrapping_add((STEP * self.motor_speed * PER_RADIAN) as i32 as u32);
        (self.angle, torque)
    }
}

impl Default for Rattle {
    fn default() -> Self {
        Self::new()
    }
}
