//! Frequency response from a record of the multisine, line by line.

use super::TestConfig;
use super::complex::Complex;
use super::multisine::Line;
use crate::math::{sin_cos, sqrt};

/// Response of the motor's acceleration to its torque at one frequency.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Response {
    /// Frequency (rad/s).
    pub frequency: f64,
    /// Acceleration per torque, real and imaginary part (1/(kg m2)).
    pub acceleration: [f64; 2],
    /// Standard deviation of each part, from noise in torque and angle (1/(kg m2)).
    pub standard_deviation: f64,
    /// Amplitude of the torque that was correlated with (N m).
    pub torque: f64,
}

impl Response {
    pub(crate) fn complex(&self) -> Complex {
        Complex::new(self.acceleration[0], self.acceleration[1])
    }
}

/// `sin(x)/x`.
fn sinc(x: f64) -> f64 {
    if x.abs() < 1.0e-4 { 1.0 - x * x / 6.0 } else { sin_cos(x).0 / x }
}

/// The response of one line over a record of so many blocks; `viscous` friction (N m s/rad) is taken off.
///
/// The torque is held over a block of D ticks and the angle is the mean of its samples, which come a tick after the
/// torque begins: with `Theta/T = G`, the correlations give `G sinc(w D t/2) sin(w D t/2)/(D sin(w t/2)) exp(j w (t/2 -
/// delay))`. That the hold also makes images at multiples of the blocks' rate changes it by less than 1e-4 at twelve
/// blocks a period.
pub(crate) fn of(line: &Line, config: &TestConfig, blocks: u32, viscous: f64) -> Response {
    let w = line.frequency;
    let complex =
        |[re, im]: [f32; 2]| Complex::new(f64::from(re), f64::from(im)).scaled(2.0 / f64::from(blocks.max(1)));
    let (period, block) = (config.period, config.block);
    let increase = Complex::new(1.0, 0.0).minus(Complex::direction(-w * block));
    let torque = complex(line.torque);
    let half = 0.5 * w * block;
    let gain = sinc(half) * sinc(half) / sinc(0.5 * w * period);
    let ratio = complex(line.angle).over(increase).over(torque).scaled(1.0 / gain);
    let delay = 0.5 * period - config.settings.delay;
    let response = ratio.times(Complex::direction(-w * delay)).scaled(-w * w);
    // T = (J w' + b w): the friction's part of 1/H is b/(j w).
    let one = Complex::new(1.0, 0.0);
    let response = one.over(one.over(response).minus(Complex::new(0.0, -viscous / w)));
    let size = sqrt(torque.square()).max(f64::MIN_POSITIVE);
    // Of each part of an amplitude through a Hann window: sigma sqrt(3/n).
    let samples = f64::from(blocks) * f64::from(config.ticks);
    let noise = sqrt(3.0 / samples.max(1.0)) / size;
    let angle = w * w * config.resolution * noise / sqrt(12.0);
    let share = noise * config.settings.torque_accuracy;
    // Rounding in single precision is 1e-4 of the response.
    let square = response.square() * (share * share + 1.0e-8) + angle * angle;
    Response { frequency: w, acceleration: [response.re, response.im], standard_deviation: sqrt(square), torque: size }
}
