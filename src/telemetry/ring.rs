//! The ring between the tick and the main loop.

use core::sync::atomic::{AtomicU32, Ordering};

use super::frame;
use super::record::{MOST_VALUES, Record};

/// A ring of records for one that records (the tick) and one that takes (the main loop); a static serves both. Two that
/// record, or two that take, garble records.
#[derive(Debug)]
// Not logged: a tick writes it while it is read.
pub struct Ring<const VALUES: usize, const RECORDS: usize> {
    slots: [Slot<VALUES>; RECORDS],
    head: AtomicU32,
    tail: AtomicU32,
    /// Ticks recorded, kept or dropped.
    ticks: AtomicU32,
}

#[derive(Debug)]
struct Slot<const VALUES: usize> {
    tick: AtomicU32,
    values: [AtomicU32; VALUES],
}

impl<const VALUES: usize, const RECORDS: usize> Ring<VALUES, RECORDS> {
    const MASK: u32 = {
        assert!(RECORDS.is_power_of_two() && RECORDS >= 2, "a ring must have a power of two of records, two at least");
        assert!(VALUES >= 1 && VALUES <= MOST_VALUES, "a record must have between 1 and 21 values");
        RECORDS as u32 - 1
    };

    /// An empty ring; it holds one record less than its size, a power of two.
    pub const fn new() -> Self {
        let _ = Self::MASK;
        Ring {
            slots: [const { Slot { tick: AtomicU32::new(0), values: [const { AtomicU32::new(0) }; VALUES] } }; RECORDS],
            head: AtomicU32::new(0),
            tail: AtomicU32::new(0),
            ticks: AtomicU32::new(0),
        }
    }

    /// Records a tick; drops it where the ring is full. The same instructions either way.
    #[inline(always)]
    pub fn record(&self, values: &[u32; VALUES]) {
        let head = self.head.load(Ordering::Relaxed);
        let tick = self.ticks.load(Ordering::Relaxed);
        self.ticks.store(tick.wrapping_add(1), Ordering::Relaxed);
        // acquire: the slot now written is no longer read
        let room = head.wrapping_sub(self.tail.load(Ordering::Acquire)) < Self::MASK;
        // the slot at the head is never one that waits to be taken: it may be written in any case. The mask is within
        // the slots
        if let Some(slot) = self.slots.get((head & Self::MASK) as usize) {
            slot.tick.store(tick, Ordering::Relaxed);
            each!(at, 0..VALUES, {
                slot.values[at].store(values[at], Ordering::Relaxed);
            });
        }
        // release: the values are written before the head
        self.head.store(head.wrapping_add(room as u32), Ordering::Release);
    }

    /// Takes the oldest record, if there is one.
    pub fn take(&self) -> Option<Record<VALUES>> {
        let tail = self.tail.load(Ordering::Relaxed);
        if self.head.load(Ordering::Acquire) == tail {
            return None;
        }
        let slot = self.slots.get((tail & Self::MASK) as usize)?;
        let tick = slot.tick.load(Ordering::Relaxed);
        let values = core::array::from_fn(|at| slot.values[at].load(Ordering::Relaxed));
        self.tail.store(tail.wrapping_add(1), Ordering::Release);
        // as many ticks as records kept and dropped before it
        Some(Record { tick, dropped: tick.wrapping_sub(tail), values })
    }

    /// Records dropped so far; wraps. A tick that interrupts may be missed by one.
    pub fn dropped(&self) -> u32 {
        let kept = self.head.load(Ordering::Acquire);
        self.ticks.load(Ordering::Relaxed).wrapping_sub(kept)
    }

    /// Sends all records that wait as frames; gives how many. A record whose writing fails is lost, and the gap shows
    /// it.
    ///
    /// # Errors
    /// The writer's error.
    pub fn send<W: embedded_io::Write>(&self, writer: &mut W) -> Result<u32, W::Error> {
        let mut sent = 0;
        while let Some(record) = self.take() {
            frame::record(&record, |bytes| writer.write_all(bytes))?;
            sent += 1;
        }
        Ok(sent)
    }
}

impl<const VALUES: usize, const RECORDS: usize> Default for Ring<VALUES, RECORDS> {
    fn default() -> Self {
        Self::new()
    }
}
