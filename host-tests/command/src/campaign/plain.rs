//! A plain loop to compare with: proportional and integral on a speed that is filtered from the encoder.

use core::f64::consts::TAU;

use driveline::design::SpeedLoopDesign;
use driveline_firmware::Words;
use driveline_firmware::scene::{Input, Output, Scene};

use driveline::settings::Bases;
use driveline_closed_loop::units::Units;

/// The filter's time constant, of the loop's own.
const FILTER: f64 = 0.05;

/// A loop without an observer, with a scene's gains, limit and ramp, and no active damping.
#[derive(Clone, Debug)]
pub struct PlainLoop {
    gains: SpeedLoopDesign,
    /// Largest torque (N m).
    limit: f64,
    /// Largest change of the setpoint in a tick (rad/s).
    ramp: f64,
    units: Units,
    angle: u32,
    speed: f64,
    ramped: f64,
    integral: f64,
}

impl PlainLoop {
    /// A loop at rest with these gains, a largest torque (N m) and a ramp (rad/s2). Its words are floats.
    pub fn new(gains: SpeedLoopDesign, limit: f64, ramp: f64, bases: Bases) -> Self {
        let units = Units::new(Words::Single, bases);
        let ramp = ramp * gains.period;
        Self { gains, limit, ramp, units, angle: 0, speed: 0.0, ramped: 0.0, integral: 0.0 }
    }
}

impl Scene for PlainLoop {
    fn tick(&mut self, input: &Input) -> Output {
        let SpeedLoopDesign { period, proportional, integral, bandwidth, .. } = self.gains;
        let turned = f64::from(input.angle.wrapping_sub(self.angle) as i32) * (TAU / 4_294_967_296.0);
        self.angle = input.angle;
        self.speed += (turned / period - self.speed) * (period * bandwidth / FILTER).min(1.0);
        let torque = if input.flags & Input::RELEASED == 0 {
            self.ramped = self.speed;
            self.integral = self.units.torque(input.setpoint).clamp(-self.limit, self.limit);
            self.integral
        } else {
            self.ramped += (self.units.speed(input.setpoint) - self.ramped).clamp(-self.ramp, self.ramp);
            let error = self.ramped - self.speed;
            self.integral += integral * period * error;
            let wanted = self.integral + proportional * error;
            let torque = wanted.clamp(-self.limit, self.limit);
            // anti-windup by back-calculation, as the library's loop
            self.integral += integral * period / proportional * (torque - wanted);
            torque
        };
        Output { torque: self.units.torque_word(torque), ..Output::default() }
    }

    fn copy(&self) -> Option<Box<dyn Scene>> {
        Some(Box::new(self.clone()))
    }
}
