//! Rigid machines whose torques follow the angle and whose inertia may, integrated step by step: what the flywheel's
//! advice is tried on.

use core::f64::consts::TAU;

use driveline::fluctuation::{CycleConfig, Fluctuation, Ripple, Waveform, WaveformConfig};
use driveline::sample::Estimate;
use driveline::settings::{Bases, Cycle};

use super::rig::{BINS, PERIOD};
use crate::runge_kutta;

/// `J(phi) phi'' + J'(phi) phi'^2/2 = a - b phi' - M(phi)`.
#[derive(Clone, Copy, Debug)]
pub struct Machine {
    /// Inertia: mean, and the cosine of twice the angle (kg m2).
    pub inertia: [f64; 2],
    /// The motor's line [N m, N m s/rad].
    pub motor: [f64; 2],
    /// Load: always, and the height of a smooth hill of a third of a turn about 160 degrees (N m).
    pub load: [f64; 2],
}

impl Machine {
    pub fn inertia(&self, phi: f64) -> f64 {
        self.inertia[0] + self.inertia[1] * (2.0 * phi).cos()
    }

    fn acceleration(&self, phi: f64, speed: f64) -> f64 {
        let from = (phi.rem_euclid(TAU) - TAU * 100.0 / 360.0) / (TAU / 3.0);
        let hill = if (0.0..1.0).contains(&from) { 0.5 - 0.5 * (TAU * from).cos() } else { 0.0 };
        let torque = self.motor[0] - self.motor[1] * speed - self.load[0] - self.load[1] * hill;
        let slope = -2.0 * self.inertia[1] * (2.0 * phi).sin();
        (torque - 0.5 * slope * speed * speed) / self.inertia(phi)
    }

    /// Goes on in so many steps of `h` (s) by Runge and Kutta's fourth order.
    fn advance(&self, phi: &mut f64, speed: &mut f64, h: f64, steps: u32) {
        for _ in 0..steps {
            let rates = |[phi, speed]: [f64; 2]| [speed, self.acceleration(phi, speed)];
            [*phi, *speed] = runge_kutta::step([*phi, *speed], h, rates);
        }
    }

    /// With a flywheel.
    pub fn with(&self, flywheel: f64) -> Machine {
        Machine { inertia: [self.inertia[0] + flywheel, self.inertia[1]], ..*self }
    }

    /// Runs until it is periodic from a guess of its speed, then over some cycles, measured by an encoder of 8192
    /// counts. Gives what was measured, and delta by the arithmetic mean as it was.
    pub fn measured(&self, guess: f64, settle: f64, cycles: u32) -> (Ripple, CycleConfig, f64) {
        let (mut phi, mut speed) = (0.1, guess);
        // Coarsely, and the last two seconds as finely as what is measured.
        self.advance(&mut phi, &mut speed, 1e-3, (settle / 1e-3) as u32);
        self.advance(&mut phi, &mut speed, PERIOD / 4.0, 80_000);
        let cycle = CycleConfig::new(Cycle::TURN, PERIOD, Bases::SI);
        let config = WaveformConfig::new::<BINS>(cycle, cycles);
        let mut waveform = Waveform::<BINS, f64>::default();
        let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
        loop {
            self.advance(&mut phi, &mut speed, PERIOD / 4.0, 4);
            (least, most) = (least.min(speed), most.max(speed));
            let angle = ((phi / TAU * 8192.0).floor() as i64 as u32) << 19;
            waveform.measure(&config, angle, 0.0, &Estimate::default());
            if let Some(window) = waveform.take() {
                return (window.ripple(&config, 16).unwrap(), cycle, 2.0 * (most - least) / (most + least));
            }
        }
    }
}
