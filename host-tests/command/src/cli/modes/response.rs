//! Forced vibration of a machine, every part referred to the motor.

use driveline::machine::{Damper, Joint};
use driveline_solver::plant::vibration::{Network, Spring};
use nalgebra::Complex;

use super::network::network;
use crate::machine_file::MachineFile;

/// Points of a response, evenly spread by their logarithm, beside those about its resonances.
const POINTS: usize = 400;

/// Damping ratio below which a vibration is undamped: a thousand roundings.
const UNDAMPED: f64 = 1e-12;

/// An angle per torque (rad/(N m)) that is that of an undamped resonance.
const ENDLESS: f64 = 1e60;

/// A machine under torques of one frequency.
#[derive(Clone)]
pub struct Response {
    network: Network,
    joints: Vec<Joint>,
}

impl Response {
    /// Of a machine whose gaps are closed.
    pub fn of(machine: &MachineFile) -> Self {
        Self { network: network(machine), joints: machine.joints() }
    }

    /// With a damper on a mass.
    pub fn with(&self, mass: usize, damper: &Damper) -> Self {
        let mut damped = self.clone();
        let ring = damped.network.coordinate(damper.inertia, 0.0);
        damped.network.link(Spring::shaft(mass, ring, damper.stiffness).damping(damper.damping));
        damped
    }

    /// Largest torque of a shaft (N m) under torques (N m) of a frequency (rad/s): `|(k + i omega d) dq|`; none
    /// where it grows without end.
    pub fn shaft_torque(&self, omega: f64, torques: &[Complex<f64>]) -> Option<f64> {
        let angles = self.network.responses(&[Complex::new(0.0, omega)], torques).pop()?;
        let torque = |joint: &Joint| {
            let stiffness = Complex::new(joint.shaft.stiffness, omega * joint.shaft.damping);
            (stiffness * (angles[joint.from] - angles[joint.to])).norm()
        };
        let largest = self.joints.iter().map(torque).fold(0.0, f64::max);
        largest.is_finite().then_some(largest)
    }

    /// Angles of a mass per torque on it (rad/(N m)) at shifts (1/s); infinite at an undamped resonance.
    pub fn receptances(&self, mass: usize, shifts: &[Complex<f64>]) -> Vec<f64> {
        let mut torques = vec![Complex::from(0.0); mass + 1];
        torques[mass] = Complex::from(1.0);
        let size = |angles: Vec<Complex<f64>>| {
            let size = angles[mass].norm();
            if size < ENDLESS { size } else { f64::INFINITY }
        };
        self.network.responses(shifts, &torques).into_iter().map(size).collect()
    }

    /// Angle of a mass per torque on it (rad/(N m)); infinite at an undamped resonance.
    pub fn receptance(&self, mass: usize, omega: f64) -> f64 {
        self.receptances(mass, &[Complex::new(0.0, omega)])[0]
    }

    /// Largest angle of a mass per torque on it (rad/(N m)) between two frequencies (rad/s); none where an
    /// undamped resonance lies between them.
    pub fn largest(&self, mass: usize, [low, high]: [f64; 2]) -> Option<f64> {
        let at = |omega: f64| self.receptance(mass, omega);
        let even = |point: usize| low * (high / low).powf(point as f64 / POINTS as f64);
        let mut points: Vec<f64> = (0..=POINTS).map(even).collect();
        let modes = self.network.modes(self.most());
        for vibration in self.network.decays(&modes).ok()?.iter().filter(|one| (low..=high).contains(&one.omega)) {
            let (decay, omega) = (vibration.decay.abs(), vibration.omega);
            if decay > UNDAMPED * omega {
                points.extend([-4.0, -1.0, 0.0, 1.0, 4.0].map(|widths| omega + widths * decay));
            } else if at(omega * (1.0 + 1e-7)) > 10.0 * at(omega * (1.0 + 1e-5)) {
                // a hundred times where the mass takes part, once where it is a node
                return None;
            }
        }
        points.retain(|point| (low..=high).contains(point));
        points.sort_by(f64::total_cmp);
        let shifts: Vec<Complex<f64>> = points.iter().map(|&omega| Complex::new(0.0, omega)).collect();
        let sizes = self.receptances(mass, &shifts);
        let mut largest = sizes.iter().copied().fold(0.0, f64::max);
        for (place, size) in points.windows(3).zip(sizes.windows(3)) {
            if size[1] >= size[0] && size[1] >= size[2] {
                largest = largest.max(peak(at, place[0], place[2]));
            }
        }
        largest.is_finite().then_some(largest)
    }

    /// Modes that are looked for.
    fn most(&self) -> usize {
        if self.network.is_distributed() { self.joints.len().max(super::chain::LEAST) } else { usize::MAX }
    }

    /// Its network.
    pub const fn network(&self) -> &Network {
        &self.network
    }
}

/// The largest value between two places that enclose one peak, by golden section.
fn peak(of: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let mut largest = 0.0;
    // 1e-8 of the width, whose square is a rounding
    for _ in 0..40 {
        let (left, right) = (high - golden * (high - low), low + golden * (high - low));
        let [below, above] = [of(left), of(right)];
        largest = below.max(above).max(largest);
        if below > above {
            high = right;
        } else {
            low = left;
        }
    }
    largest
}
