//! A record of a tick.

/// Most values of a record: with its kind, tick and count of drops they fill a packet of 96 bytes.
pub(super) const MOST_VALUES: usize = 21;

/// Record of a tick.
///
/// ```
/// use driveline::telemetry::Ring;
/// static RING: Ring<2, 4> = Ring::new();
/// // five ticks (speed, torque) before the main loop comes: a ring of four holds three, two are dropped
/// (0..5).for_each(|tick| RING.record(&[f32::to_bits(100.0 + tick as f32), f32::to_bits(40.0)]));
/// let records: Vec<_> = std::iter::from_fn(|| RING.take()).collect();
/// assert_eq!((records.len(), RING.dropped()), (3, 2));
/// assert_eq!((records[2].tick, f32::from_bits(records[2].values[0])), (2, 102.0));
/// ```
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
