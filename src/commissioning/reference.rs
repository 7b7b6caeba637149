//! The moving reference: an angle whose speed goes to a target at a steady rate.

use super::TestConfig;

/// Where the motor ought to be.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Reference {
    /// Angle from where the test began (2^-32 turn).
    pub angle: i64,
    /// Speed (rad/s).
    pub speed: f32,
    /// Speed that it goes to (rad/s).
    pub target: f32,
    /// How fast it goes there (rad/s2).
    pub rate: f32,
    /// Acceleration in this block (rad/s2).
    pub acceleration: f32,
}

impl Reference {
    /// Goes to a speed at a rate.
    pub(crate) fn go(&mut self, target: f32, rate: f32) {
        self.target = target;
        self.rate = rate;
    }

    /// Whether the target is reached.
    pub(crate) fn is_there(&self) -> bool {
        self.speed == self.target
    }

    /// Moves on by a block.
    #[inline(always)]
    pub(crate) fn step(&mut self, config: &TestConfig) {
        let h = config.block_f32;
        let most = self.rate * h;
        let change = (self.target - self.speed).min(most).max(-most);
        let mean = self.speed + 0.5 * change;
        // exactly there at the end, whatever the rounding
        self.speed = if change.abs() < most { self.target } else { self.speed + change };
        self.acceleration = change / h;
        self.angle += (mean * h * config.units) as i64;
    }
}
