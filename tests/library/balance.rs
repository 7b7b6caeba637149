//! Balancing: phasors on the tick, influence coefficients off it, weights, the procedure, in-run, the command.

mod by_itself;
mod disturbed_rotors;
mod holes;
mod in_run;
mod influence;
mod min_max;
mod modal;
mod never_harmful;
mod phasor;
mod polygon;
mod procedure;
mod tolerance;

use std::f64::consts::{PI, TAU};

use driveline::balancing::{Complex, InRunConfig};

use crate::noise::Noise;

/// Of the grinding spindle: the largest correction of its head (kg m), its speed, 3000 r/min, and the residual of 25 kg
/// at that speed in G2.5 [ISO 21940-11], 2.5e-3 m/s of the centre of mass.
const CAPACITY: f64 = 1.5e-3;
const SPEED: f64 = 100.0 * PI;
const MASS: f64 = 25.0;
const G2_5: f64 = 2.5e-3 * MASS / SPEED;

/// Its settings.
const SPINDLE: InRunConfig<f64, 1> = InRunConfig {
    probe: CAPACITY / 50.0,
    limits: [CAPACITY],
    step: 2.0 * CAPACITY,
    bound: 1.3,
    target: 0.01,
    forgetting: 0.7,
    noise: 0.005,
};

const ZERO: Complex<f64> = Complex::new(0.0, 0.0);

/// Of a size, at any phase.
fn turned(size: f64, noise: &mut Noise) -> Complex<f64> {
    Complex::from_polar(size, TAU * noise.even())
}
