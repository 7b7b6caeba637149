//! The panel of the hoist's adaptive drive: it names rope and load, and answers what has been learnt.
//!
//! The torque constant and the motor's inertia are learnt with the empty hook and a test weight, up and down at rated
//! speed and with steps of the speed.

use driveline::adaptive::{self, Known};
use driveline::drive::{Composition, ConfigOf};

use super::machine::Hoist;
use crate::scene::composed::{Beside, Composed};

type HoistDrive<N> = adaptive::HoistDrive<Hoist<10_000>, N, 5, 4>;

/// The drive with its schedule and learners, at 10 kHz.
pub type Learnt<N> = Composed<HoistDrive<N>, Named>;

/// Keys of the panel, with a value as the bits of `f32`.
pub mod panel {
    /// The rope has this length now (m).
    pub const ROPE: u32 = 1;
    /// A known load hangs on the hook (kg); a negative number ends it.
    pub const LOAD: u32 = 2;
    /// Answers the learnt gain of the torque.
    pub const GAIN: u32 = 3;
    /// The torque's offset (N m).
    pub const OFFSET: u32 = 4;
    /// The friction of the gear per shaft torque.
    pub const LOSS: u32 = 5;
    /// The motor's inertia over that of the drawings.
    pub const MOTOR: u32 = 6;
    /// The encoder's eccentricity (rad).
    pub const ECCENTRICITY: u32 = 7;
}

/// The load that the panel has named (kg).
#[derive(Clone, Copy)]
pub struct Named(Option<f32>);

macro_rules! named {
    ($($number:ty),+) => {$(
        impl Beside<HoistDrive<$number>> for Named {
            fn start(_: &mut HoistDrive<$number>, _: &ConfigOf<HoistDrive<$number>>) -> Self {
                Named(None)
            }

            #[inline]
            fn panel(
                &mut self,
                drive: &mut HoistDrive<$number>,
                config: &mut &'static ConfigOf<HoistDrive<$number>>,
                [key, value]: [u32; 2],
            ) -> u32 {
                let number = f32::from_bits(value);
                if key == panel::LOAD {
                    self.0 = (number >= 0.0).then_some(number);
                }
                drive.background(config, &Known { rope: (key == panel::ROPE).then_some(number), load: self.0 });
                if key == 0 {
                    return 0;
                }
                let learnt = drive.learnt();
                let answer = match key {
                    panel::GAIN => 1.0 + learnt.torque[0],
                    panel::OFFSET => learnt.torque[1],
                    panel::LOSS => learnt.friction,
                    panel::MOTOR => 1.0 + learnt.inertia,
                    panel::ECCENTRICITY => drive.observer().amplitude_and_phase()[0] as f32,
                    _ => return 0,
                };
                answer.to_bits()
            }

            #[cfg(not(target_os = "none"))]
            fn copy(&self) -> Option<Self> {
                Some(*self)
            }
        }
    )+};
}

named!(f32, driveline::number::Fixed);
