//! Eccentricity of the encoder: an angle of once a turn that no torque explains.

use super::complex::Complex;
use super::figure::Figure;
use super::harmonic::Harmonic;
use crate::math::{atan2, sqrt};

/// First-order eccentricity of the encoder: it reads the angle plus `amplitude cos(angle - phase)`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Eccentricity {
    /// Amplitude (rad).
    pub amplitude: Figure,
    /// Phase (rad), from -pi to pi: the angle, from where the encoder read zero, at which it reads most ahead.
    pub phase: f64,
}

/// Phasor of one order, per block: the angle that torque does not explain for a machine of this inertia.
fn unexplained(order: &Harmonic, halves: f64, mean_speed: f64, inertia: f64, block: f64, sum: f64) -> Complex {
    let complex = |[re, im]: [f32; 2]| Complex::new(f64::from(re), f64::from(im)).scaled(2.0 / sum);
    let speed = 0.5 * halves * mean_speed;
    let turn = Complex::new(1.0, 0.0).minus(Complex::direction(-speed * block));
    let angle = complex(order.speed).over(turn);
    let torque = complex(order.torque);
    // The torque's own motion: -T/(J w^2).
    angle.plus(torque.scaled(1.0 / (inertia * speed * speed)))
}

/// The eccentricity, from the correlation over `blocks` at a mean speed (rad/s); its spread from the neighbouring
/// orders, where an encoder has none.
///
/// `start` is the absolute angle at which the test began (rad).
pub(crate) fn of(
    orders: &[Harmonic; 3],
    mean_speed: f64,
    inertia: f64,
    block: f64,
    blocks: u32,
    start: f64,
) -> (Eccentricity, [f64; 2]) {
    // A Hann window of 1 - cos sums up to the number of its blocks.
    let sum = f64::from(blocks.max(1));
    let [half, one, more] = orders;
    let found = unexplained(one, 2.0, mean_speed, inertia, block, sum);
    // The motion by torque noise falls with the square of the order: both neighbours count as at the first.
    let below = unexplained(half, 1.0, mean_speed, inertia, block, sum).scaled(0.25);
    let above = unexplained(more, 3.0, mean_speed, inertia, block, sum).scaled(2.25);
    let spread = sqrt(0.5 * (below.square() + above.square()));
    let amplitude = sqrt(found.square());
    let phase = atan2(-found.im, found.re) + start;
    let turns = phase / core::f64::consts::TAU;
    let whole = turns + if turns >= 0.0 { 0.5 } else { -0.5 };
    let phase = phase - core::f64::consts::TAU * (whole as i64) as f64;
    // e cos(angle - phase) = e cos(phase) cos(angle) + e sin(phase) sin(angle)
    (Eccentricity { amplitude: Figure { value: amplitude, standard_deviation: spread }, phase }, [found.re, -found.im])
}
