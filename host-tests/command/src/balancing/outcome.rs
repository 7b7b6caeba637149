//! What came of balancing a scene.

use serde::Serialize;

/// A vibration or an unbalance: size and angle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Vector {
    /// Size, in the unit of what it is of.
    pub size: f64,
    /// Angle [degrees].
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
    /// The unbalance that is left in each plane [kg m].
    pub unbalance: Vec<Vector>,
    /// The vibration of each row, a channel at a speed [m].
    pub vibration: Vec<Vector>,
    /// The same as the firmware read it, in the sensors' unit, where it did.
    pub read: Vec<Vector>,
    /// What the scene is judged by: a grade, or a share of the vibration as found.
    pub measure: f64,
    /// Time since the start [s].
    pub time: f64,
}

/// What a scene has to show, and what it showed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Claim {
    /// What is measured.
    pub name: String,
    /// What was measured.
    pub measured: f64,
    /// What it may be at most.
    pub limit: f64,
}

impl Claim {
    /// Whether it holds. What is not a number does not.
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
    /// What [`Stage::measure`] is.
    pub measure: String,
    /// Names of the rows.
    pub rows: Vec<String>,
    /// The stages, as found first.
    pub stages: Vec<Stage>,
    /// What it had to show.
    pub claims: Vec<Claim>,
    /// Readings that the panel did not believe, by reason.
    pub doubts: Vec<String>,
    /// A number that two runs share if every word of their outputs is the same.
    pub fingerprint: u64,
    /// Most instructions of a tick, and their mean; zero on the host.
    pub instructions: (u32, f64),
    /// Speeds [rad/s], and for each stage the largest amplitude of the channels there [m].
    pub over_speed: (Vec<f64>, Vec<Vec<f64>>),
    /// Simulated time [s].
    pub time: f64,
}
