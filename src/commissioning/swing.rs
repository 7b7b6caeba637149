//! The watch on the shaft's swing while the motor's inertia alone is known.

use super::TestConfig;
use super::servo::{Deviation, Servo};

/// A disturbance observer of the motor's inertia: its disturbance is the shaft torque, as far as it is quick enough.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct SwingWatch {
    observer: Servo,
    state: Deviation,
    /// Blocks until the observer has settled.
    settles: u32,
    /// Shaft torque (N m) when it last passed the limit on the other side than before.
    passed: f32,
    /// How often it did without a pause, and the blocks since.
    passes: u32,
    since: u32,
    /// Blocks in a period of the band's lower end: the pause after which a swing is another one.
    pause: u32,
}

/// Passes of a swing of two periods. A jump of the speed, as of an angle that freezes, has two.
const PASSES: u32 = 4;

/// Blocks in which the observer forgets its initial state down to 3e-4, with its poles at a quarter of a block each.
const SETTLES: u32 = 48;

impl SwingWatch {
    /// For a motor of this inertia (kg m2), from this state; a greater inertia finds a swing earlier.
    pub(crate) fn new(config: &TestConfig, inertia: f64, state: Deviation) -> Self {
        let [low, _] = config.settings.band;
        Self {
            observer: Servo::quick(config, inertia),
            state,
            settles: SETTLES,
            passed: 0.0,
            passes: 0,
            since: 0,
            pause: config.blocks(1.0 / low),
        }
    }

    /// One block: the measurement under `torque`, while the reference accelerated. Whether the shaft swings: its torque
    /// (N m) has been beyond the limit on one side and the other, several times.
    #[inline(always)]
    pub(crate) fn observe(&mut self, config: &TestConfig, measured: f32, torque: f32, acceleration: f32) -> bool {
        self.observer.observe(&mut self.state, config.block_f32, measured, torque, acceleration);
        self.settles = self.settles.saturating_sub(1);
        self.since = self.since.saturating_add(1);
        if self.since > self.pause {
            (self.passed, self.passes) = (0.0, 0);
        }
        let shaft = self.state.disturbance;
        // Written so that a value that is not a number counts as beyond.
        if self.settles == 0 && !(shaft.abs() <= config.swing) && !(shaft * self.passed > 0.0) {
            self.passed = shaft;
            self.passes = self.passes.saturating_add(1);
            self.since = 0;
        }
        self.passes >= PASSES
    }
}
