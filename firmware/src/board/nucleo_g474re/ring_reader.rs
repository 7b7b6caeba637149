//! The reader's side of a ring that a DMA channel fills in a circle.

/// Where the reader is in a ring of `SIZE`.
#[derive(Clone, Copy, Debug, Default)]
pub struct RingReader<const SIZE: usize> {
    at: usize,
}

impl<const SIZE: usize> RingReader<SIZE> {
    /// The place of the next unread element; `left` is the channel's count of elements to the end of the ring.
    ///
    /// It loses nothing as long as fewer than `SIZE` elements are unread; more than that cannot be told from few.
    pub const fn next(&mut self, left: usize) -> Option<usize> {
        // the channel counts from SIZE down to 1; it may be read as 0 for the moment in which it is reloaded
        let filled = SIZE.saturating_sub(left) % SIZE;
        if filled == self.at {
            return None;
        }
        let at = self.at;
        self.at = (at + 1) % SIZE;
        Some(at)
    }
}
