//! The vibration sensor.

use crate::fault::Faults;

/// A sensor of vibration.
pub trait VibrationSensor<N> {
    /// The newest sample, `None` where none has come since the last call and none is overdue.
    ///
    /// # Errors
    /// [`Faults::VIBRATION_CLIPPED`] where the sensor was at an end of its range, [`Faults::VIBRATION_MISSING`] where
    /// the sample is not sound otherwise, or overdue.
    fn vibration(&mut self) -> Result<Option<N>, Faults>;
}
