//! Values that commissioning has to identify.

use driveline_solver::plant::train::{Coordinate, Link, Train};

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
        let least = |train: &Train| {
            let found = train.modes().map_or(Vec::new(), |modes| modes.omega);
            found.into_iter().filter(|w| *w > 1.0e-3).fold(f64::INFINITY, f64::min)
        };
        let rotors =
            |inertia: &[f64]| inertia.iter().fold(Train::new(), |train, j| train.coordinate(Coordinate::new(*j)));
        let shafts = || stiffness.iter().zip(damping).enumerate();
        let free =
            shafts().fold(rotors(inertia), |train, (s, (k, d))| train.link(Link::shaft(s, s + 1, *k).damping(*d)));
        // The motor locked: its shaft goes to the ground.
        let held = shafts().fold(rotors(&inertia[1..]), |train, (s, (k, _))| match s {
            0 => train.link(Link::ground(0, *k)),
            _ => train.link(Link::shaft(s - 1, s, *k)),
        });
        let resonance = least(&free);
        let antiresonance = least(&held);
        let total: f64 = inertia.iter().sum();
        let motor = total * (antiresonance / resonance).powi(2);
        let load = total - motor;
        let decays = free.modes().and_then(|modes| free.decays(&modes)).unwrap_or_default();
        let swings = decays.into_iter().filter(|swing| swing.omega > 1.0e-3 * resonance);
        let ratio = swings.min_by(|a, b| a.omega.total_cmp(&b.omega)).map_or(0.0, |slowest| slowest.damping_ratio());
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
