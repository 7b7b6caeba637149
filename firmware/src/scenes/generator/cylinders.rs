//! The diesel set with its cylinders watched: the waveform of a four-stroke cycle in the tick, the verdicts between the
//! ticks.
//!
//! The encoder's index and the cam are set so that the angle is zero at the first cylinder's firing dead centre, and the
//! drive is switched on in that turn: from then on it counts the two turns of a cycle. The coupling's antiresonance, 12.6
//! Hz, lies at the half order at rated speed, where the flywheel hardly moves: the engine's description has the coupling.

use driveline::drive::{Composition, ConfigOf};
use driveline::fluctuation::{Coupling, CylinderReading, CylinderVerdict, Engine, Waveform};
use driveline::governor::FeedForward;
use driveline::number::Fixed;

use super::{DIESEL_CHAIN, DriveOf, Switches};
use crate::scene::composed::Beside;
use crate::scene::{Input, Output};

/// Bins of the waveform: eleven and more to the firing interval.
pub const BINS: usize = 64;

/// Cylinders, in the firing order 1-5-3-6-2-4.
pub const CYLINDERS: usize = 6;

/// The engine, its coupling and the generator.
pub const ENGINE: Engine<CYLINDERS> = Engine {
    firing_order: [1, 5, 3, 6, 2, 4],
    first: 0.0,
    peak: 0.5,
    inertia: DIESEL_CHAIN.masses()[0],
    coupling: Some(Coupling { stiffness: 5.0e4, damping: 66.0, load: DIESEL_CHAIN.masses()[1] }),
    turns: 2,
};

/// The drive of the diesel set with the waveform of its cycle.
pub type Drive<N> = DriveOf<N, FeedForward, 32, Waveform<BINS>>;

/// Requests of the panel beside [`super::panel`]'s: a cylinder's number (1 to 6) added to the key.
pub mod panel {
    /// The share of the cylinder's torque in the median of all, as the bits of `f32`.
    pub const SHARE: u32 = 16;
    /// Its verdict: [`super::verdict_word`], or 0 before the first window.
    pub const VERDICT: u32 = 32;
    /// Windows of eight cycles that were finished.
    pub const WINDOWS: u32 = 48;
}

/// A verdict as a word: 1 good, 2 weak, 3 misfire, 4 uncertain.
pub fn verdict_word(verdict: CylinderVerdict) -> u32 {
    match verdict {
        CylinderVerdict::Good => 1,
        CylinderVerdict::Weak => 2,
        CylinderVerdict::Misfire => 3,
        CylinderVerdict::Uncertain => 4,
    }
}

/// The set's switches, and the cylinders of the last window.
pub struct Cylinders {
    switches: Switches,
    found: Option<[CylinderReading; CYLINDERS]>,
    windows: u32,
}

macro_rules! watched {
    ($($number:ty),+) => {$(
        impl Beside<Drive<$number>> for Cylinders {
            fn constants(config: &'static ConfigOf<Drive<$number>>) -> &'static ConfigOf<Drive<$number>> {
                <Switches as Beside<Drive<$number>>>::constants(config)
            }

            fn start(drive: &mut Drive<$number>, config: &ConfigOf<Drive<$number>>) -> Self {
                Cylinders { switches: Switches::start(drive, config), found: None, windows: 0 }
            }

            #[inline(always)]
            fn tick(&mut self, drive: &mut Drive<$number>, config: &ConfigOf<Drive<$number>>, input: &Input) -> Output {
                self.switches.tick(drive, config, input)
            }

            fn panel(&mut self, drive: &mut Drive<$number>, config: &mut &'static ConfigOf<Drive<$number>>, asked: [u32; 2]) -> u32 {
                if let Some(window) = drive.fluctuation_mut().take()
                    && let Ok(ripple) = window.ripple(&config.drive.fluctuation, CYLINDERS / 2)
                {
                    // the rack's torque is that of the gases, friction included
                    let torque = f64::from(window.motor_torque(&config.drive.fluctuation, 1).mean);
                    // a tick counts as a tooth: twelve to the turn at least
                    self.found = Some(ripple.cylinders(&ENGINE, torque, BINS));
                    self.windows = self.windows.wrapping_add(1);
                }
                let cylinder = |first: u32| {
                    let number = asked[0].wrapping_sub(first);
                    self.found.iter().flatten().find(|cylinder| u32::from(cylinder.number) == number)
                };
                match asked[0] {
                    panel::WINDOWS => self.windows,
                    17..=22 => cylinder(panel::SHARE).map_or(0, |cylinder| (cylinder.share as f32).to_bits()),
                    33..=38 => cylinder(panel::VERDICT).map_or(0, |cylinder| verdict_word(cylinder.verdict)),
                    _ => self.switches.panel(drive, config, asked),
                }
            }
        }
    )+};
}

watched!(f32, Fixed);
