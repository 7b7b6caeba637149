//! The angle between two teeth.

use super::cycle::ToothRecord;
use super::description::{ToothedWheelConfig, next_place, tooth};
use super::state::{Open, Synchronization, ToothedWheel};
use crate::fault::Faults;

/// Teeth in a row that may be without an edge.
pub const SKIPPED: u32 = 2;

/// The angle from a wheel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct WheelAngle {
    /// The angle (2^-32 turn).
    pub angle: u32,
    /// Its standard deviation (2^-32 turn), from the errors of the predicted passages.
    pub deviation: u32,
}

impl<R: ToothRecord> ToothedWheel<R> {
    /// The angle at `now`, on the same clock. To be read in every tick, so that a stopped wheel is not taken for one
    /// that has just turned once.
    ///
    /// # Errors
    /// [`Faults::ANGLE_MISSING`] where the place is not known or doubtful, or a tooth is overdue by more than half a
    /// pitch.
    pub fn at<const TEETH: usize>(
        &mut self,
        config: &ToothedWheelConfig<TEETH>,
        now: u32,
    ) -> Result<WheelAngle, Faults> {
        if self.synchronization != Synchronization::Known {
            return Err(Faults::ANGLE_MISSING);
        }
        let next = next_place(config, self.place);
        let (Some(last), Some(next)) = (tooth(config, self.place), tooth(config, next)) else {
            return Err(Faults::ANGLE_MISSING);
        };
        let elapsed = now.wrapping_sub(self.track.passage) as i32;
        let due = self.track.time_of(next.span.saturating_add(next.slack));
        if elapsed >= 0 && elapsed as u32 > due {
            if elapsed as u32 > due.saturating_mul(2 + SKIPPED) {
                self.lose();
            }
            return Err(Faults::ANGLE_MISSING);
        }
        if self.open != Open::Nothing {
            return Err(Faults::ANGLE_MISSING);
        }
        let scale = self.track.scale();
        let angle = last.angle.wrapping_add(scale.angle(elapsed));
        Ok(WheelAngle { angle, deviation: scale.angle(self.track.deviation() as i32) })
    }
}
