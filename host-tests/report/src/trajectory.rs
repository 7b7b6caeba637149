//! Time series of a run: true and estimated values of the three quantities.

use serde::{Deserialize, Serialize};

use super::results::diverged_as_null;

/// One variant in one situation over time.
///
/// Each trajectory has its own truth: the drive acts on the machine, so that variants see different courses.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
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
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Signal {
    /// From the full solver.
    #[serde(with = "series")]
    pub truth: Vec<f64>,
    /// From the observer.
    #[serde(with = "series")]
    pub estimate: Vec<f64>,
}

/// An event at a time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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

/// A series in which JSON's `null` stands for what is not finite.
mod series {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    #[derive(Serialize, Deserialize)]
    #[serde(transparent)]
    struct Value(#[serde(with = "super::diverged_as_null")] f64);

    pub fn serialize<S: Serializer>(values: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(values.iter().map(|&value| Value(value)))
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<f64>, D::Error> {
        Ok(Vec::<Value>::deserialize(deserializer)?.into_iter().map(|Value(value)| value).collect())
    }
}
