//! A case and its tolerance.

use serde::Serialize;

/// A case and what came of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Case {
    /// What kind of case it is.
    pub group: &'static str,
    /// The case.
    pub name: String,
    /// What is compared.
    pub compared: &'static str,
    /// Largest error, relative.
    pub found: f64,
    /// What it may be.
    pub allowed: f64,
}

impl Case {
    /// Whether it is within its tolerance. What is not a number is not.
    pub fn holds(&self) -> bool {
        self.found <= self.allowed
    }
}

/// The larger of two errors; what is not a number is without bound.
pub fn larger(worst: f64, error: f64) -> f64 {
    if error.is_nan() { f64::INFINITY } else { worst.max(error) }
}
