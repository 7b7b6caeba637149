//! Errors in a rotor's description.

/// Why a rotor or a question about it was refused: the parameter, where it stands, what it was and what was expected.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RotorError {
    /// A number out of its range.
    #[error("{name} of {place} is {value}: expected {expected}")]
    Parameter {
        /// The parameter.
        name: &'static str,
        /// The element, disc, bearing, station or sensor that it belongs to.
        place: String,
        /// Given value.
        value: f64,
        /// Expected value.
        expected: &'static str,
    },
    /// An index of a node that the rotor does not have.
    #[error("{place} stands at node {node}: the nodes are 0 to {last}")]
    Node {
        /// Value found.
        place: String,
        node: usize,
        /// The last node there is.
        last: usize,
    },
    /// Unbalances that do not match the stations, or a rotor without elements.
    #[error("{name}: {found} given, expected {expected}")]
    Count {
        /// Counted items.
        name: &'static str,
        /// How many were given.
        found: usize,
        /// How many would do.
        expected: usize,
    },
    #[error(
        "the bearings do not hold the rotor: some motion of it meets no stiffness, or so little beside that of \
        the shaft that rounding hides it"
    )]
    NotHeld,
    /// Natural whirls that rounding hides, or that may not be all.
    #[error(
        "the natural whirls at {speed} rad/s are not certain: stiffness, damping or mass of some part is too far from \
        that of the others; expected a rotor without a part that stands out so, such as a longer shortest element"
    )]
    Unproven {
        /// The speed, rad/s.
        speed: f64,
    },
    /// An undamped rotor exactly on a critical speed.
    #[error("at {speed} rad/s the vibration has no bound: an undamped critical speed")]
    Unbounded {
        /// The speed, rad/s.
        speed: f64,
    },
}

/// Passes a finite number for which `holds`.
pub(super) fn check(
    name: &'static str,
    place: impl FnOnce() -> String,
    value: f64,
    holds: bool,
    expected: &'static str,
) -> Result<(), RotorError> {
    if holds && value.is_finite() {
        Ok(())
    } else {
        Err(RotorError::Parameter { name, place: place(), value, expected })
    }
}

/// Passes a finite number above zero.
pub(super) fn positive(name: &'static str, place: impl FnOnce() -> String, value: f64) -> Result<(), RotorError> {
    check(name, place, value, value > 0.0, "a finite number above zero")
}
