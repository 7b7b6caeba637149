//! A record of a tick.

/// Most values of a record: with its kind, tick and count of drops they fill a packet of 96 bytes.
pub(super) const MOST_VALUES: usize = 21;

/// Record of a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Record<const VALUES: usize> {
    /// Number of the tick, from 0; wraps.
    pub tick: u32,
    /// Records dropped before it; wraps.
    pub dropped: u32,
    /// The values, as bits of the drive's number.
    pub values: [u32; VALUES],
}
