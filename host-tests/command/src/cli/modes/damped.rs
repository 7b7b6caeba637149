//! Damped vibrations of machines and trains: exact eigenvalues.

use std::f64::consts::TAU;

use driveline_report::format::significant;
use driveline_report::{Section, Table};
use driveline_solver::plant::vibration::Decay;
use serde::Serialize;

/// A vibration with damping about standstill, or a decay without vibration: the eigenvalue `-decay + i frequency`.
#[derive(Clone, Debug, Serialize)]
pub struct DampedVibration {
    /// Decay (1/s); below zero where the motion grows.
    pub decay: f64,
    /// Frequency (rad/s); 0 of a decay.
    pub frequency: f64,
    /// Frequency (Hz).
    pub hz: f64,
    /// Damping ratio.
    pub damping_ratio: f64,
}

impl DampedVibration {
    /// Of eigenvalues; none where nothing damps.
    pub fn all(decays: &[Decay]) -> Vec<Self> {
        let damped = |decay: &Decay| Self {
            decay: decay.decay,
            frequency: decay.omega,
            hz: decay.omega / TAU,
            damping_ratio: decay.damping_ratio(),
        };
        let is_damped = decays.iter().any(|decay| decay.decay != 0.0);
        if is_damped { decays.iter().map(damped).collect() } else { Vec::new() }
    }
}

/// The table; none where nothing damps.
pub fn table(damped: &[DampedVibration], about: &str) -> Option<Section> {
    let mut table = Table::new(["Hz", "rad/s", "decay 1/s", "damping ratio"]);
    for one in damped {
        table.row([one.hz, one.frequency, one.decay, one.damping_ratio].map(significant));
    }
    let still = damped.iter().any(|one| one.frequency == 0.0);
    let text = format!("{about}{}", if still { " A decay without vibration has no frequency." } else { "" });
    (!damped.is_empty()).then(|| Section::new("Damped vibrations", text, table))
}
