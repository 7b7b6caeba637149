//! Errors in a description.

use super::event::Place;

/// Why a chain was refused: the parameter, where it stands, what it was and what was expected.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PlantError {
    /// A number out of its range.
    #[error("{name} of {place} is {value}: expected {expected}")]
    Parameter {
        /// The parameter, as in the table of [`crate::plant`].
        name: &'static str,
        /// The node or shaft it belongs to.
        place: Place,
        /// Given value.
        value: f64,
        /// Expected value.
        expected: &'static str,
    },
    /// A list that does not match the chain, or an index outside it.
    #[error("{name}: {found} given, expected {expected}")]
    Count {
        /// Counted items.
        name: &'static str,
        /// How many were given.
        found: usize,
        /// How many would do.
        expected: usize,
    },
    /// Table times that do not increase.
    #[error("time {time} s of the load program of {place} does not lie after the one before it")]
    TimesNotIncreasing {
        /// The node that the program loads.
        place: Place,
        /// The offending time, s.
        time: f64,
    },
}

/// Passes a finite number above zero.
pub(super) fn positive(name: &'static str, place: Place, value: f64) -> Result<(), PlantError> {
    in_range(name, place, value, value > 0.0, "a finite number above zero")
}

/// Passes a finite number that is not negative.
pub(super) fn not_negative(name: &'static str, place: Place, value: f64) -> Result<(), PlantError> {
    in_range(name, place, value, value >= 0.0, "a finite number, zero or above")
}

/// Passes a finite number.
pub(super) fn finite(name: &'static str, place: Place, value: f64) -> Result<(), PlantError> {
    in_range(name, place, value, true, "a finite number")
}

/// Passes a finite number for which `holds`.
pub(super) fn in_range(
    name: &'static str,
    place: Place,
    value: f64,
    holds: bool,
    expected: &'static str,
) -> Result<(), PlantError> {
    if holds && value.is_finite() { Ok(()) } else { Err(PlantError::Parameter { name, place, value, expected }) }
}
