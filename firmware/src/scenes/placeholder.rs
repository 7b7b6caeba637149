//! A small stand-in for a drive, in both numbers: it exercises the link, not the library.
//!
//! Speed from wrapped angle differences through a first-order filter, a torque proportional to the speed error.

use crate::scene::{Input, Output, Scene};

/// Ticks a second.
const RATE_HZ: u32 = 10_000;

/// The placeholder in single precision, SI units.
pub struct Single {
    last_angle: u32,
    speed: f32,
}

impl Scene for Single {
    const NAME: &'static str = "placeholder/f32/rigid/10000";
    const RATE_HZ: u32 = RATE_HZ;

    fn new() -> Self {
        Single {
            last_angle: 0,
            speed: 0.0,
        }
    }

    fn tick(&mut self, input: &Input) -> Output {
        // rad/s for one count of 2^32 a turn in one tick
        const COUNT: f32 = (RATE_HZ as f64 * core::f64::consts::TAU / 4_294_967_296.0) as f32;
        let step = input.angle.wrapping_sub(self.last_angle) as i32;
        self.last_angle = input.angle;
        self.speed += 0.1 * (step as f32 * COUNT - self.speed);
        let released = input.flags & Input::RELEASED != 0;
        let torque = if released {
            0.5 * (f32::from_bits(input.reference) - self.speed)
        } else {
            0.0
        };
        Output {
            torque: torque.to_bits(),
            motor_speed: self.speed.to_bits(),
            shaft_torque: (f32::from_bits(input.torque) * 0.5).to_bits(),
            load_speed: (f32::from_bits(input.vibration[0]) + self.speed).to_bits(),
            load_torque: (f32::from_bits(input.vibration[1]) / (self.speed * self.speed + 1.0))
                .to_bits(),
            faults: u32::from(step == i32::MIN),
            ..Output::default()
        }
    }
}

/// The placeholder in fixed point: speeds in angle counts a tick, torques as given.
pub struct Fixed {
    last_angle: u32,
    speed: i32,
}

impl Scene for Fixed {
    const NAME: &'static str = "placeholder/fixed/rigid/10000";
    const RATE_HZ: u32 = RATE_HZ;

    fn new() -> Self {
        Fixed {
            last_angle: 0,
            speed: 0,
        }
    }

    fn tick(&mut self, input: &Input) -> Output {
        let step = input.angle.wrapping_sub(self.last_angle) as i32;
        self.last_angle = input.angle;
        let gap = i64::from(step) - i64::from(self.speed);
        self.speed = self.speed.saturating_add((gap >> 3) as i32);
        let released = input.flags & Input::RELEASED != 0;
        let torque = if released {
            (input.reference as i32).saturating_sub(self.speed) >> 1
        } else {
            0
        };
        Output {
            torque: torque as u32,
            motor_speed: self.speed as u32,
            shaft_torque: ((input.torque as i32) >> 1) as u32,
            load_speed: (input.vibration[0] as i32).wrapping_add(self.speed) as u32,
            load_torque: ((i64::from(input.vibration[1] as i32) * i64::from(self.speed)) >> 32)
                as u32,
            faults: u32::from(step == i32::MIN),
            ..Output::default()
        }
    }
}
