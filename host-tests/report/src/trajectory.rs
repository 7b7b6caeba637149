//! Time series of a run: true and estimated values of the three quantities.

/// One variant in one situation over time.
///
/// Each trajectory has its own truth: the drive acts on the machine, so that variants see different courses.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trajectory {
    /// The variant's label, as [`super::Variant::label`].
    pub variant: String,
    /// The situation: `load step`, `lowering`.
    pub situation: String,
    /// Time (s), rising.
    pub time: Vec<f64>,
    /// Shaft torque at the motor (N m).
    pub shaft_torque: Signal,
    /// Load speed at the motor (rad/s).
    pub load_speed: Signal,
    /// Load torque at the motor (N m).
    pub load_torque: Signal,
    /// Events with their times.
    pub marks: Vec<Mark>,
}

/// Truth and estimate of one quantity, a value for each time. Values that are not finite are gaps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Signal {
    /// From the full solver.
    pub truth: Vec<f64>,
    /// From the observer.
    pub estimate: Vec<f64>,
}

/// An event at a time.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// Time (s).
    pub time: f64,
    /// The event, in one to three words.
    pub label: String,
}

impl Signal {
    /// Estimate less truth, as long as both have values.
    pub fn error(&self) -> Vec<f64> {
        self.estimate.iter().zip(&self.truth).map(|(estimate, truth)| estimate - truth).collect()
    }
}
