//! Programs of the load.

use super::error::{PlantError, finite};
use super::event::Place;

/// Load torque of a node against time, added to its constant load. Positive torque opposes positive speed.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadProgram {
    /// Time s, torque N m, in order of time.
    points: Vec<(f64, f64)>,
    linear: bool,
}

impl LoadProgram {
    /// From each time (s) on, that torque (N m); zero before the first.
    #[must_use]
    pub fn steps(points: &[(f64, f64)]) -> Self {
        Self { points: points.to_vec(), linear: false }
    }

    /// Straight lines through the points (s, N m); the first and the last torque before and after.
    #[must_use]
    pub fn table(points: &[(f64, f64)]) -> Self {
        Self { points: points.to_vec(), linear: true }
    }

    /// The same torques the other way.
    pub(super) fn negated(mut self) -> Self {
        self.points.iter_mut().for_each(|point| point.1 = -point.1);
        self
    }

    /// Torque at `time`, N m, and its rate to the right, N m/s.
    #[must_use]
    pub fn at(&self, time: f64) -> (f64, f64) {
        let passed = self.points.partition_point(|point| point.0 <= time);
        let before = passed.checked_sub(1).and_then(|i| self.points.get(i));
        let after = self.points.get(passed);
        match (before, after) {
            (Some(a), Some(b)) if self.linear => {
                let rate = (b.1 - a.1) / (b.0 - a.0);
                (a.1 + rate * (time - a.0), rate)
            }
            (Some(a), _) => (a.1, 0.0),
            (None, Some(b)) if self.linear => (b.1, 0.0),
            _ => (0.0, 0.0),
        }
    }

    /// The next corner after `time`, s.
    pub(super) fn corner_after(&self, time: f64) -> Option<f64> {
        self.points.get(self.points.partition_point(|point| point.0 <= time)).map(|point| point.0)
    }

    pub(super) fn validate(&self, place: Place) -> Result<(), PlantError> {
        let mut last = f64::NEG_INFINITY;
        for &(time, torque) in &self.points {
            finite("time of the load program", place, time)?;
            finite("torque of the load program", place, torque)?;
            if time <= last {
                return Err(PlantError::TimesNotIncreasing { place, time });
            }
            last = time;
        }
        Ok(())
    }
}
