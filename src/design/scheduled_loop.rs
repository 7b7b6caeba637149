//! Speed loop of a member of a family of machines.

use super::Error;
use super::speed_loop::{SpeedLoopDesign, SpeedLoopTuning};
use super::tuning::Rate;
use crate::machine::TwoMass;

impl TwoMass {
    /// The speed loop of [`try_speed_loop`](Self::try_speed_loop), no faster than `bandwidth` (rad/s) nor than 0.4 of
    /// the antiresonance, with a gain on the twist rate of `twist_gain` times the proportional one.
    ///
    /// The antiresonance of a light load is high: at 0.4 of it the observer, which is not that fast, is in the loop.
    ///
    /// # Errors
    /// As [`try_speed_loop`](Self::try_speed_loop); [`Error::TwistGain`] for a ratio that is not above zero and finite.
    pub const fn try_limited_speed_loop(
        &self,
        rate: Rate,
        bandwidth: f64,
        twist_gain: f64,
    ) -> Result<SpeedLoopDesign, Error> {
        if !(twist_gain > 0.0 && twist_gain.is_finite()) {
            return Err(Error::TwistGain);
        }
        get!(self.check(), Error::Machine);
        let share = bandwidth / self.antiresonance();
        let usual = SpeedLoopTuning::USUAL;
        // a bandwidth that is not a number stays one, and is refused
        let tuning =
            SpeedLoopTuning { bandwidth: if share > usual.bandwidth { usual.bandwidth } else { share }, ..usual };
        self.try_speed_loop(rate, tuning.with_twist_gain(self, twist_gain))
    }
}
