//! Results of balancing a scene.

use serde::Serialize;

/// A vibration or an unbalance: size and angle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Vector {
    /// Size, in the unit of what it is of.
    pub size: f64,
    /// Angle (degrees).
    pub angle: f64,
}

impl Vector {
    /// Of a complex amplitude.
    #[must_use]
    pub fn of(value: nalgebra::Complex<f64>) -> Self {
        let (size, angle) = driveline_solver::rotor::Polar::of(value);
        Vector { size, angle }
    }
}

/// The rotor as it was at a stage of the work, by the full solver.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Stage {
    /// As found, corrected, trimmed.
    pub name: String,
    /// The unbalance that is left in each plane (kg m).
    pub unbalance: Vec<Vector>,
    /// The vibration of each row, a channel at a speed (m).
    pub vibration: Vec<Vector>,
    /// The same as the firmware read it, in the sensors' unit, where it did.
    pub read: Vec<Vector>,
    /// Criterion of the scene: a grade, or a share of the initial vibration.
    pub measure: f64,
    /// Time since the start (s).
    pub time: f64,
}

/// Criteria of a scene, and its results.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Claim {
    /// Measured quantity.
    pub name: String,
    /// Measurement.
    pub measured: f64,
    /// Its limit.
    pub limit: f64,
}

impl Claim {
    /// Whether it holds. A value that is not a number fails.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.measured <= self.limit
    }
}

/// A scene that was balanced.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outcome {
    /// The scene.
    pub scene: String,
    /// Meaning of [`Stage::measure`].
    pub measure: String,
    /// Names of the rows.
    pub rows: Vec<String>,
    /// The stages, as found first.
    pub stages: Vec<Stage>,
    /// Its criteria.
    pub claims: Vec<Claim>,
    /// Readings rejected by the panel, by reason.
    pub doubts: Vec<String>,
    /// A number that two runs share if every word of their outputs is the same.
    pub fingerprint: u64,
    /// Most instructions of a tick, and their mean; zero on the host.
    pub instructions: (u32, f64),
    /// Simulated time (s).
    pub time: f64,
}
