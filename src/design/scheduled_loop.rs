//! Speed loop of a member of a family of machines.

use super::Error;
use super::speed_loop::{SpeedLoopDesign, SpeedLoopTuning};
use super::tuning::Rate;
use crate::machine::TwoMass;
use crate::math::sqrt;

impl TwoMass {
    /// The speed loop of [`try_speed_loop`](Self::try_speed_loop), no faster than `bandwidth` (rad/s) nor than 0.4 of
    /// the antiresonance, with the damping ratio of the shaft at which the gain on the twist rate is a tenth of the
    /// proportional one, or less.
    ///
    /// The antiresonance of a light load is high: at 0.4 of it the observer, which is not that fast, is in the loop.
    ///
    /// # Errors
    /// As [`try_speed_loop`](Self::try_speed_loop).
    pub const fn try_limited_speed_loop(&self, rate: Rate, bandwidth: f64) -> Result<SpeedLoopDesign, Error> {
        let share = bandwidth / self.antiresonance();
        let usual = SpeedLoopTuning::USUAL;
        let mut tuning =
            SpeedLoopTuning { bandwidth: if share < usual.bandwidth { share } else { usual.bandwidth }, ..usual };
        // To 1 %: from 1e-3 to 10 in ten halvings of the exponent.
        let (mut low, mut high) = (1e-3, 10.0);
        let mut halving = 0;
        while halving < 10 {
            tuning.shaft_damping = sqrt(low * high);
            let [proportional, _, damping, _] = self.speed_loop_gains(&tuning);
            if damping > 0.1 * proportional {
                high = tuning.shaft_damping;
            } else {
                low = tuning.shaft_damping;
            }
            halving += 1;
        }
        tuning.shaft_damping = low;
        self.try_speed_loop(rate, tuning)
    }
}
