//! Greatest and least value of a quantity, with their times.

/// Greatest and least value since a watch began.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extremes {
    /// In the quantity's unit.
    pub peak: f64,
    /// s.
    pub peak_time: f64,
    /// In the quantity's unit.
    pub least: f64,
    /// s.
    pub least_time: f64,
}

impl Extremes {
    /// Of the first value.
    pub(super) fn of(value: f64, time: f64) -> Self {
        Self { peak: value, peak_time: time, least: value, least_time: time }
    }

    /// With one value more.
    pub(super) fn take(&mut self, value: f64, time: f64) {
        if value > self.peak {
            (self.peak, self.peak_time) = (value, time);
        }
        if value < self.least {
            (self.least, self.least_time) = (value, time);
        }
    }
}
