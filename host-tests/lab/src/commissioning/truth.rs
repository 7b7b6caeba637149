//! Values that commissioning has to identify.

use driveline_solver::plant::modes::{System, SystemError};

/// Values to identify.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truth {
    /// In the order of `driveline_firmware::scenes::commission::figures`; NaN where there is nothing to compare with.
    pub figures: [f64; 14],
}

impl Truth {
    /// Of a chain of inertias, stiffnesses and dampings, all at the motor: first resonance and first antiresonance of
    /// the whole chain, and the two masses that have them and the same sum.
    pub fn of(inertia: &[f64], stiffness: &[f64], damping: &[f64]) -> Self {
        let least = |found: Result<Vec<f64>, SystemError>| {
            let found = found.unwrap_or_default().into_iter().filter(|w| *w > 1.0e-3);
            found.fold(f64::INFINITY, f64::min)
        };
        let shafts = || stiffness.iter().zip(damping).enumerate();
        let free = shafts().fold(System::new(inertia), |system, (s, (k, d))| system.shaft(s, s + 1, *k, *d));
        // The motor locked: its shaft goes to the ground.
        let held = shafts().fold(System::new(&inertia[1..]), |system, (s, (k, d))| match s {
            0 => system.ground(0, *k, *d),
            _ => system.shaft(s - 1, s, *k, *d),
        });
        let resonance = least(free.frequencies());
        let antiresonance = least(held.frequencies());
        let total: f64 = inertia.iter().sum();
        let motor = total * (antiresonance / resonance).powi(2);
        let load = total - motor;
        // Of the slowest swing: the real part over the size of its eigenvalue.
        let swings =
            free.damped_eigenvalues().unwrap_or_default().into_iter().filter(|(_, im)| *im > 1.0e-3 * resonance);
        let slowest = swings.fold((0.0, f64::INFINITY), |a, b| if b.1 < a.1 { b } else { a });
        let ratio = -slowest.0 / slowest.0.hypot(slowest.1);
        let stiffness = load * antiresonance * antiresonance;
        let damping = 2.0 * ratio * resonance * motor * load / total;
        let nothing = f64::NAN;
        let mut figures = [nothing; 14];
        let known = [total, motor, load, resonance, antiresonance, stiffness, damping, ratio, 0.0, 0.0, 0.0];
        figures[..11].copy_from_slice(&known);
        Truth { figures }
    }

    /// With Coulomb (N m) and viscous friction (N m s/rad).
    pub fn friction(mut self, coulomb: f64, viscous: f64) -> Self {
        (self.figures[8], self.figures[9]) = (coulomb, viscous);
        self
    }

    /// With a weight (N m).
    pub fn weight(mut self, weight: f64) -> Self {
        self.figures[10] = weight;
        self
    }

    /// With an eccentricity of the encoder: amplitude and phase (rad).
    pub fn eccentricity(mut self, eccentricity: [f64; 2]) -> Self {
        self.figures[12..].copy_from_slice(&eccentricity);
        self
    }

    /// With a gap (rad).
    pub fn gap(mut self, gap: f64) -> Self {
        self.figures[11] = gap;
        self
    }
}
