//! The description of a cam, and what cam and index have shown.

/// A cam's edges, `EDGES` to the cycle. Made by [`crate::settings`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Cam<const EDGES: usize> {
    /// Their places in the cycle (2^-32 cycle).
    pub edges: [u32; EDGES],
    /// How far an edge may be from its place, as a cam's drive may be stretched or shifted (2^-32 cycle).
    pub tolerance: u32,
}

/// The phase of the cycle, as the edges of cam and index have shown it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Phase {
    /// Parts of the cycle, counted from the one assumed, that the wheel may be in.
    pub left: u32,
    /// Turns of an even wheel with all teeth between two edges of the index; none before its first edge.
    pub turns: Option<u32>,
}

impl Phase {
    pub const NEW: Phase = Phase { left: u32::MAX, turns: None };

    /// Whether the index has shown all teeth of a turn.
    pub fn counted(&self) -> bool {
        self.turns.is_some_and(|turns| turns > 0)
    }
}
