//! The motor's angle sensor.

use crate::fault::Faults;

/// A sensor of the motor's angle.
pub trait AngleSensor {
    /// The angle now, 2^32 to the turn.
    ///
    /// # Errors
    /// [`Faults::ANGLE_MISSING`] where there is none that is new and sound.
    fn angle(&mut self) -> Result<u32, Faults>;
}
