//! Excitations of a plant: laws of the motor, programs of the load.

use super::error::{PlantError, finite, positive};
use super::event::Place;

/// Torque of the motor in a stand-alone run, added to the torque held by [`crate::plant::Plant::advance`].
/// `[Wang 1989 §1-2]`, `[Huang 1987 §2.2]`. Time is the plant's.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum MotorLaw {
    /// Nothing but the held torque.
    #[default]
    Held,
    /// A constant torque, N m.
    Constant(f64),
    /// Soft start `torque (1 - t/time)` for `t < time`, zero afterwards.
    Ramp {
        /// At the start, N m.
        torque: f64,
        /// Starting time, s, above zero.
        time: f64,
    },
    /// Linear characteristic `stall - slope w` `[Wang 1989 (1-6)]`.
    Line {
        /// At standstill, N m.
        stall: f64,
        /// Fall with speed, N m s/rad.
        slope: f64,
    },
}

impl MotorLaw {
    /// Torque at standstill at `time`, N m, and its rate, N m/s.
    pub(super) fn torque(&self, time: f64) -> (f64, f64) {
        match *self {
            MotorLaw::Held => (0.0, 0.0),
            MotorLaw::Constant(torque) => (torque, 0.0),
            MotorLaw::Ramp { torque, time: end } if time < end => (torque * (1.0 - time / end), -torque / end),
            MotorLaw::Ramp { .. } => (0.0, 0.0),
            MotorLaw::Line { stall, .. } => (stall, 0.0),
        }
    }

    /// Fall of the torque with speed, N m s/rad.
    pub(super) fn slope(&self) -> f64 {
        if let MotorLaw::Line { slope, .. } = *self { slope } else { 0.0 }
    }

    /// The next corner after `time`, s.
    pub(super) fn corner_after(&self, time: f64) -> Option<f64> {
        match *self {
            MotorLaw::Ramp { time: end, .. } if end > time => Some(end),
            _ => None,
        }
    }

    pub(super) fn validate(&self) -> Result<(), PlantError> {
        let motor = Place::Node(0);
        match *self {
            MotorLaw::Held => Ok(()),
            MotorLaw::Constant(torque) => finite("motor torque", motor, torque),
            MotorLaw::Ramp { torque, time } => {
                finite("motor torque", motor, torque)?;
                positive("starting time", motor, time)
            }
            MotorLaw::Line { stall, slope } => {
                finite("motor torque", motor, stall)?;
                finite("slope of the motor's characteristic", motor, slope)
            }
        }
    }
}

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
