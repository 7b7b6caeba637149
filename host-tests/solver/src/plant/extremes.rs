//! Greatest and least value of a quantity, with their times.

/// Share by which the same extreme of two periods may differ, by the roundings of the run between them.
const ALIKE: f64 = 1e-12;

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

    /// With one value more. Of values that are alike to their roundings the first stays.
    pub(super) fn take(&mut self, value: f64, time: f64) {
        if value > self.peak + ALIKE * self.peak.abs() {
            (self.peak, self.peak_time) = (value, time);
        }
        if value < self.least - ALIKE * self.least.abs() {
            (self.least, self.least_time) = (value, time);
        }
    }
}
