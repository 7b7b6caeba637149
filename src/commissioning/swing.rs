//! The watch on the shaft's swing while the motor's inertia alone is known.

use super::TestConfig;
use super::servo::{Deviation, Servo};

/// A disturbance observer of the motor's inertia: its disturbance is the shaft torque, as far as it is quick enough.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct SwingWatch {
    observer: Servo,
    state: Deviation,
    /// Blocks until it has settled.
    settles: u32,
    /// Shaft torque when it last came beyond the limit on another side than before, and how often it did.
    side: f32,
    sides: u32,
}

/// Sides of a swing of two periods. A jump of the speed, as of an angle that freezes, has two.
const SIDES: u32 = 3;

/// Blocks in which the observer forgets what it began from: to the part 3e-4 of it, with its poles at a quarter of a
/// block each.
const SETTLES: u32 = 48;

impl SwingWatch {
    /// For a motor of this inertia \[kg m2\], from this state; a greater inertia finds a swing earlier.
    pub(crate) fn new(config: &TestConfig, inertia: f64, state: Deviation) -> Self {
        Self { observer: Servo::quick(config, inertia), state, settles: SETTLES, side: 0.0, sides: 0 }
    }

    /// One block: the measurement under `torque`, while the reference accelerated. Whether the shaft swings: its torque
    /// \[N m\] has been beyond the limit on one side and the other, several times.
    #[inline(always)]
    pub(crate) fn observe(&mut self, config: &TestConfig, measured: f32, torque: f32, acceleration: f32) -> bool {
        self.observer.observe(&mut self.state, config.block_f32, measured, torque, acceleration);
        self.settles = self.settles.saturating_sub(1);
        let shaft = self.state.disturbance;
        // Written so that a value that is not a number counts as beyond.
        if self.settles == 0 && !(shaft.abs() <= config.swing) && !(shaft * self.side > 0.0) {
            self.side = shaft;
            self.sides = self.sides.saturating_add(1);
        }
        self.sides > SIDES
    }
}
