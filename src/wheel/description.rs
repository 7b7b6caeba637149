//! The description of a wheel: its teeth.

use super::place::{RATIOS, Set};

/// A tooth. Made by [`crate::settings`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Tooth {
    /// Its angle (2^-32 turn).
    pub angle: u32,
    /// The same less that of the tooth before (2^-32 turn): its span.
    pub span: u32,
    /// Half of the least of the spans before and behind it (2^-32 turn).
    pub slack: u32,
    /// Spans to a turn [2^-12].
    pub spans: u32,
}

/// The constants of a wheel with `TEETH` teeth. Made by [`crate::settings`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ToothedWheelConfig<const TEETH: usize> {
    /// The teeth.
    pub teeth: [Tooth; TEETH],
    /// Teeth in the smallest part of the wheel that repeats; all of them where none does.
    pub sector: u32,
    /// For each ratio of two successive intervals: the teeth of the sector that it may end at.
    pub(crate) fitting: [Set; RATIOS],
    /// Turns to a cycle.
    pub turns: u32,
    /// Longest time of a turn (clock counts): below that speed there is no angle.
    pub slowest: u32,
    /// Time of a count of the clock (s).
    pub period: f64,
}

/// The tooth at a place.
pub(super) fn tooth<const TEETH: usize>(config: &ToothedWheelConfig<TEETH>, place: u32) -> Option<&Tooth> {
    config.teeth.get(place as usize)
}

/// The place behind.
pub(super) fn next_place<const TEETH: usize>(_: &ToothedWheelConfig<TEETH>, place: u32) -> u32 {
    if place as usize + 1 >= TEETH { 0 } else { place.wrapping_add(1) }
}

/// The place before.
pub(super) fn before_place<const TEETH: usize>(_: &ToothedWheelConfig<TEETH>, place: u32) -> u32 {
    place.checked_sub(1).unwrap_or((TEETH as u32).wrapping_sub(1))
}
