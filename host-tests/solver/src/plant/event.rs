//! Events of a plant, with time and place.

use std::fmt;

/// A place in a chain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Place {
    /// The inertia of this index; 0 is the motor.
    Node(usize),
    /// The shaft between the nodes of this index and the next.
    Shaft(usize),
    /// The pins of the mechanism on the coordinate of this index.
    Pins(usize),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::Node(node) | Place::Pins(node) => write!(f, "node {node}"),
            Place::Shaft(shaft) => write!(f, "shaft {shaft}"),
        }
    }
}

/// The kinds of change that end one linear stretch of the motion and begin the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum EventKind {
    /// A flank was met (`new` = +1 drive side, -1 back side) or left (`new` = 0). For a rope +1 is taut, 0 slack.
    Contact,
    /// A node with friction came to rest and is held; `new` = 0.
    Stop,
    /// A held node broke loose in the direction `new`.
    Slip,
    /// A node with friction passed through zero speed without being held, on to the direction `new`.
    Reversal,
    /// The torque behind a lossy gear changed its sign to `new`.
    Flow,
    /// More than a thousand events in one tick: the rest of the tick was run without any; `new` = 0.
    Unresolved,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// When, s since the start of the plant.
    pub time: f64,
    /// What.
    pub kind: EventKind,
    /// Where.
    pub place: Place,
    /// The state that was entered, -1, 0 or +1; see [`EventKind`].
    pub new: i8,
}
