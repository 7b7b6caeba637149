//! The quantities of a train that can be read or watched.

use crate::plant::extremes::Extremes;

/// A quantity to read or to watch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Signal {
    /// Of a coordinate, rad or m.
    Angle(usize),
    /// Of a coordinate, rad/s or m/s.
    Speed(usize),
    /// Of a link, rad or m.
    Elongation(usize),
    /// Of a link, N m or N, damping included; zero in its gap.
    Force(usize),
    /// Of a link without what its damper adds.
    Elastic(usize),
    /// Of a friction, against its motion.
    Friction(usize),
    /// On a coordinate, all but its links, N m or N: its inertia times its acceleration, and what the links take. Of a
    /// coordinate without a crank.
    Outside(usize),
}

/// Greatest and least of a signal so far.
#[derive(Debug, Clone, Copy)]
pub(super) struct Watch {
    pub signal: Signal,
    pub extremes: Extremes,
}
