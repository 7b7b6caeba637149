//! Dry friction, between a coordinate and the ground or between two.

use super::super::error::{PlantError, finite, in_range, not_negative};
use super::super::event::Place;

/// Dry friction on the speed `sum c_j v_j` of its terms, against a surface that may move itself. It sticks up to its
/// breakaway torque and slides with its kinetic torque.
#[derive(Debug, Clone, PartialEq)]
pub struct Friction {
    pub(super) terms: Vec<(usize, f64)>,
    pub(super) kinetic: f64,
    pub(super) breakaway: f64,
    pub(super) surface: f64,
    /// Lossy links whose front this coordinate is.
    pub(super) losses: Vec<usize>,
}

impl Friction {
    /// Of a coordinate against the ground, N m or N.
    #[must_use]
    pub fn ground(at: usize, torque: f64) -> Self {
        Self { terms: vec![(at, 1.0)], kinetic: torque, breakaway: torque, surface: 0.0, losses: Vec::new() }
    }

    /// Between two coordinates.
    #[must_use]
    pub fn between(one: usize, other: usize, torque: f64) -> Self {
        Self { terms: vec![(one, 1.0), (other, -1.0)], ..Self::ground(one, torque) }
    }

    /// The same with another torque to break loose, at least the kinetic one.
    #[must_use]
    pub fn breakaway(mut self, torque: f64) -> Self {
        self.breakaway = torque;
        self
    }

    /// The same on a surface that moves at this speed, rad/s or m/s.
    #[must_use]
    pub fn surface(mut self, speed: f64) -> Self {
        self.surface = speed;
        self
    }

    pub(super) fn validate(&self, coordinates: usize) -> Result<(), PlantError> {
        for &(at, _) in &self.terms {
            if at >= coordinates {
                return Err(PlantError::Count { name: "coordinate of a friction", found: at, expected: coordinates });
            }
        }
        if let [(one, _), (other, _)] = self.terms[..]
            && one == other
        {
            return Err(PlantError::Count { name: "coordinates of a friction between two", found: 1, expected: 2 });
        }
        let place = Place::Node(self.terms[0].0);
        not_negative("kinetic friction", place, self.kinetic)?;
        let enough = self.breakaway >= self.kinetic;
        in_range("breakaway friction", place, self.breakaway, enough, "at least the kinetic friction")?;
        finite("speed of the surface", place, self.surface)
    }
}
