//! An incremental encoder on a timer that counts its quadrature.

use driveline::axis::AngleSensor;
use driveline::fault::Faults;

/// A timer that counts the edges of an encoder, up and down.
pub trait Counter {
    /// Faults: `core::convert::Infallible` where it is a register.
    type Error;

    /// The count now. It wraps after the number of bits given to [`Quadrature`].
    ///
    /// # Errors
    /// The timer's fault: a lost clock, a quadrature error.
    fn count(&mut self) -> Result<u32, Self::Error>;
}

/// The angle of a motor from an incremental encoder.
///
/// The angle is zero where it was made. Between two readings the motor must turn by less than half of the counter's
/// range.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Quadrature<C> {
    counter: C,
    /// Counts of a turn: four times the encoder's lines.
    turn: i32,
    /// 2^64 over the counts of a turn.
    reciprocal: u64,
    /// Bits of a counter's word that do not count.
    unused: u32,
    last: Option<u32>,
    /// Counts since zero, modulo a turn.
    position: i32,
    /// Where the index stands: at its first pulse, and after a slip where it is then.
    index: Option<i32>,
    /// Counts that the index has shown to be lost.
    slipped: i32,
    /// Whether the next reading has to report it.
    lost: bool,
}

impl<C> Quadrature<C> {
    /// A counter of `bits` bits (16 or 32, say) that counts `counts_per_turn`, four times the encoder's lines.
    ///
    /// # Panics
    /// Where `counts_per_turn` is not within 2 to 2^24, or `bits` not within 8 to 32; in a constant at compile time.
    pub const fn new(counter: C, counts_per_turn: u32, bits: u32) -> Self {
        assert!(
            counts_per_turn >= 2 && counts_per_turn <= 1 << 24,
            "an encoder must have between 2 and 16,777,216 counts a turn"
        );
        assert!(bits >= 8 && bits <= 32, "a counter must have between 8 and 32 bits");
        Quadrature {
            counter,
            turn: counts_per_turn as i32,
            reciprocal: u64::MAX / counts_per_turn as u64,
            unused: 32 - bits,
            last: None,
            position: 0,
            index: None,
            slipped: 0,
            lost: false,
        }
    }

    /// Records the encoder's index pulse at `count`. The place of the first one is kept. A later one more than a count
    /// off it, by a whole number of turns, shows that counts were lost or gained, all at once or one by one. The next
    /// reading reports it. A single count is within the width of the index.
    ///
    /// The interrupt of the index must not come between two readings that are more than a turn apart.
    pub fn index(&mut self, count: u32) {
        let Some(last) = self.last else { return };
        let place = self.wrapped(self.position.saturating_add(self.difference(count, last)));
        let first = *self.index.get_or_insert(place);
        let ahead = self.wrapped(place.saturating_sub(first));
        let off = if ahead > self.turn >> 1 { ahead.saturating_sub(self.turn) } else { ahead };
        if !(-1..=1).contains(&off) {
            self.slipped = self.slipped.saturating_add(off);
            self.lost = true;
            // a loss is reported once: the next one is measured from here
            self.index = Some(place);
        }
    }

    /// Counts that the index has shown to be lost or gained since the first pulse: by so many the angle is ahead of the
    /// shaft.
    pub fn slipped(&self) -> i32 {
        self.slipped
    }

    /// Counts from `last` to `count`, the shorter way round.
    fn difference(&self, count: u32, last: u32) -> i32 {
        (count.wrapping_sub(last) << self.unused) as i32 >> self.unused
    }

    /// Counts modulo a turn.
    fn wrapped(&self, counts: i32) -> i32 {
        // a turn is at least 2, so that there is neither a division by zero nor one that overflows
        counts.checked_rem_euclid(self.turn).unwrap_or(0)
    }
}

impl<C: Counter> Quadrature<C> {
    /// The angle now, 2^32 to the turn.
    ///
    /// # Errors
    /// [`Faults::ANGLE_MISSING`] where the timer gives none, or where the index has shown that counts were lost; the
    /// latter once for each slip.
    #[inline]
    pub fn read(&mut self) -> Result<u32, Faults> {
        let count = self.counter.count().map_err(|_| Faults::ANGLE_MISSING)?;
        let turned = self.difference(count, self.last.unwrap_or(count));
        self.last = Some(count);
        let position = self.position.saturating_add(turned);
        // a division only past zero
        let position = if (0..self.turn).contains(&position) { position } else { self.wrapped(position) };
        self.position = position;
        if core::mem::take(&mut self.lost) {
            return Err(Faults::ANGLE_MISSING);
        }
        // position is below the counts of a turn: the product does not overflow
        Ok((position as u64).wrapping_mul(self.reciprocal).wrapping_shr(32) as u32)
    }
}

impl<C: Counter> AngleSensor for Quadrature<C> {
    #[inline]
    fn angle(&mut self) -> Result<u32, Faults> {
        self.read()
    }
}
