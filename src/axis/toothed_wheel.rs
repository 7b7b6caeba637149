//! A toothed wheel as the motor's angle sensor.

use super::AngleSensor;
use crate::fault::Faults;
use crate::wheel::{ToothRecord, ToothedWheel, ToothedWheelConfig};

/// The wheel, its constants and the time of its clock.
impl<R: ToothRecord, const TEETH: usize> AngleSensor for (&mut ToothedWheel<R>, &ToothedWheelConfig<TEETH>, u32) {
    fn angle(&mut self) -> Result<u32, Faults> {
        self.0.at(self.1, self.2).map(|angle| angle.angle)
    }
}
