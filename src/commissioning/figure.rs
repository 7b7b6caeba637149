//! A figure with its standard deviation.

/// A figure with its standard deviation, in the same unit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Figure {
    /// Value.
    pub value: f64,
    /// Standard deviation.
    pub standard_deviation: f64,
}

impl Figure {
    /// The standard deviation over the value.
    #[must_use]
    pub fn relative(&self) -> f64 {
        self.standard_deviation / self.value.abs()
    }

    /// The mean of two, as independent.
    pub(crate) fn mean(self, other: Self) -> Self {
        let square =
            self.standard_deviation * self.standard_deviation + other.standard_deviation * other.standard_deviation;
        Self { value: 0.5 * (self.value + other.value), standard_deviation: 0.5 * crate::math::sqrt(square) }
    }
}
