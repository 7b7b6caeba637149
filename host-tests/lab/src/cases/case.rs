//! A case and its tolerance.

use serde::Serialize;

/// A case and what came of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Case {
    /// Kind of case.
    pub group: &'static str,
    /// The case.
    pub name: String,
    /// Compared quantity.
    pub compared: &'static str,
    /// Largest error, relative.
    pub found: f64,
    /// Its limit.
    pub allowed: f64,
}

impl Case {
    /// Whether it is within its tolerance. A value that is not a number fails.
    pub fn holds(&self) -> bool {
        self.found <= self.allowed
    }
}

/// The larger of two errors; what is not a number is without bound.
pub fn larger(worst: f64, error: f64) -> f64 {
    if error.is_nan() { f64::INFINITY } else { worst.max(error) }
}
