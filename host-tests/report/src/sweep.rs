//! A sweep over machines and rates: where a step is right and where it is not.

use serde::{Deserialize, Serialize};

use super::results::diverged_as_null;

/// A step run over a grid of machines.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sweep {
    /// Swept parameter: `exact impulse form, f32`.
    pub name: String,
    /// Reference of the error and criterion of failure, in a sentence.
    pub criterion: String,
    /// The points, in any order.
    pub points: Vec<SweepPoint>,
}

/// One machine at one rate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepPoint {
    /// Natural frequency times the tick, omega T (rad).
    pub omega_t: f64,
    /// Load inertia over motor inertia.
    pub inertia_ratio: f64,
    /// Damping as a share of the critical.
    pub damping: f64,
    /// State error, relative.
    #[serde(with = "diverged_as_null")]
    pub error: f64,
    /// The point met its criterion.
    pub passed: bool,
}

/// Result of a sweep at one damping.
#[derive(Clone, Debug, PartialEq)]
pub struct Slice<'a> {
    /// Damping as a share of the critical.
    pub damping: f64,
    /// Its points.
    pub points: Vec<&'a SweepPoint>,
}

impl Slice<'_> {
    /// The point with the largest error; what is not finite is the largest.
    pub fn worst(&self) -> Option<&SweepPoint> {
        let size = |point: &SweepPoint| {
            if point.error.is_nan() { f64::INFINITY } else { point.error }
        };
        self.points.iter().copied().max_by(|a, b| size(a).total_cmp(&size(b)))
    }

    /// How many points failed.
    pub fn failures(&self) -> usize {
        self.points.iter().filter(|point| !point.passed).count()
    }
}

impl Sweep {
    /// The points by damping, from the smallest.
    pub fn slices(&self) -> Vec<Slice<'_>> {
        let slice = |damping: f64| {
            let points = self.points.iter().filter(|point| point.damping == damping).collect();
            Slice { damping, points }
        };
        values(self.points.iter().map(|point| point.damping)).into_iter().map(slice).collect()
    }

    /// How many points failed.
    pub fn failures(&self) -> usize {
        self.points.iter().filter(|point| !point.passed).count()
    }
}

/// The different values of an axis of the grid, rising; what is not finite is left out.
pub fn values(all: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = all.filter(|value| value.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}
