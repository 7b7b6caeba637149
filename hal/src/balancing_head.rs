//! A balancing head of two masses, each turned by a servo on a PWM channel.

use driveline::balancing::{BalancingHead, Complex, HeadPosition};
use driveline::math::{atan2, sqrt};
use embedded_hal::pwm::{ErrorType, SetDutyCycle};

/// Two equal unbalances on the rotor's axis, each at an angle that the duty of its channel sets: none is 0, the largest
/// a turn. Together they are any weight from none to twice one of them.
///
/// The servos have no answer: a move takes the time that the task is told.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TwoMassHead<P> {
    channels: [P; 2],
    mass: f32,
}

impl<P: SetDutyCycle> TwoMassHead<P> {
    /// Two channels, and the unbalance of one mass (kg m): half of the capacity.
    pub const fn new(channels: [P; 2], mass: f32) -> Self {
        TwoMassHead { channels, mass }
    }

    /// The channels again.
    pub fn release(self) -> [P; 2] {
        self.channels
    }
}

impl<P: SetDutyCycle> BalancingHead for TwoMassHead<P> {
    type Error = <P as ErrorType>::Error;

    /// Turns both masses; a weight beyond the capacity is set at it.
    fn set(&mut self, [weight]: &[Complex<f32>; 1]) -> Result<(), Self::Error> {
        let (re, im) = (f64::from(weight.re), f64::from(weight.im));
        // m (e^{ia} + e^{ib}) = 2 m cos((a - b)/2) e^{i (a + b)/2}
        let share = sqrt(re * re + im * im) / (2.0 * f64::from(self.mass));
        let share = if share < 1.0 { share } else { 1.0 };
        let (middle, half) = (atan2(im, re), atan2(sqrt(1.0 - share * share), share));
        let [first, second] = &mut self.channels;
        turn(first, middle + half)?;
        turn(second, middle - half)
    }

    fn position(&mut self) -> Result<HeadPosition, Self::Error> {
        Ok(HeadPosition::Unmeasured)
    }
}

/// Sets an angle of -1.5 to 1.5 turns (rad), rounded.
fn turn<P: SetDutyCycle>(channel: &mut P, angle: f64) -> Result<(), P::Error> {
    let turns = angle / core::f64::consts::TAU + 2.0;
    let most = channel.max_duty_cycle();
    channel.set_duty_cycle(((turns - f64::from(turns as u32)) * f64::from(most) + 0.5) as u16)
}
