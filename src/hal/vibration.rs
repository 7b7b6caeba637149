//! What gives the vibration.

use crate::fault::Faults;

/// A sensor of vibration.
pub trait VibrationSensor<N> {
    /// The newest sample, `None` where none has come since the last call and none is overdue.
    ///
    /// # Errors
    /// [`Faults::VIBRATION_MISSING`] where the sample is not sound, or overdue.
    fn vibration(&mut self) -> Result<Option<N>, Faults>;
}
