//! Whether a wheel is the one described, before its angle is given.

/// Sums over the teeth that are being checked (clock/4).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Check {
    /// Errors of all passages.
    errors: u32,
    /// Errors where the span changes, of the passages expected from the description and from the last interval.
    described: u32,
    even: u32,
    /// Half pitches.
    slack: u32,
}

impl Check {
    pub const NEW: Check = Check { errors: 0, described: 0, even: 0, slack: 0 };

    /// A tooth with its error, and where its span differs from the one before that of even teeth.
    pub fn tooth(&mut self, error: i32, slack: i32, even: Option<u32>) {
        self.errors = self.errors.saturating_add(error.unsigned_abs() >> 2);
        self.slack = self.slack.saturating_add(slack.unsigned_abs() >> 2);
        if let Some(even) = even {
            self.described = self.described.saturating_add(error.unsigned_abs() >> 2);
            self.even = self.even.saturating_add(even >> 2);
        }
    }

    /// After so many good teeth: whether they are those of the wheel; none where there must be more. `fewest` are
    /// enough where the errors are below a tenth of a pitch, twice as many otherwise. A description that is
    /// not three times as near as even teeth is wrong.
    pub fn verdict(&self, good: u32, fewest: u32) -> Option<bool> {
        let quiet = self.errors < self.slack / 5;
        if good < if quiet { fewest } else { fewest.saturating_mul(2) } {
            return None;
        }
        Some(self.described == 0 || self.described < self.even / 3)
    }
}
