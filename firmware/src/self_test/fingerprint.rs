//! One number for all bits that a scene gives back over a run: equal on host and target, or the run was not the same.

use crate::Words;
use crate::scene::{Output, Scene};
use crate::self_test::inputs::Program;

/// Ticks in a self-test.
pub const TICKS: u32 = 10_000;
/// Seed of the self-test's inputs.
pub const SEED: u32 = 2_463_534_242;

/// FNV-1a over the words of outputs, 64 bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fingerprint(u64);

impl Fingerprint {
    /// Of nothing yet.
    pub const fn new() -> Self {
        Fingerprint(0xcbf2_9ce4_8422_2325)
    }

    /// Takes in one output; the instructions, which differ between host and target, are left out.
    pub fn add(&mut self, output: &Output) {
        let Output { torque, motor_speed, shaft_torque, load_speed, load_torque, faults, instructions: _, answer } =
            *output;
        for word in [torque, motor_speed, shaft_torque, load_speed, load_torque, faults, answer] {
            self.0 = (self.0 ^ u64::from(word)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    /// The number.
    pub const fn value(self) -> u64 {
        self.0
    }
}

impl Default for Fingerprint {
    fn default() -> Self {
        Self::new()
    }
}

/// Runs a scene from rest over the self-test's inputs.
pub fn of_run(scene: &mut (impl Scene + ?Sized), words: Words) -> u64 {
    let mut inputs = Program::new(SEED, words);
    let mut fingerprint = Fingerprint::new();
    for _ in 0..TICKS {
        fingerprint.add(&scene.exchange(&inputs.next_input()));
    }
    fingerprint.value()
}
