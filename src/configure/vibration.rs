//! Measurements of a rotor's vibration for a machine.

use super::{Configure, Machine};
use crate::balancing::{Phasors, PhasorsConfig};
use crate::number::Fixed;
use crate::settings::PhasorSettings;

/// A machine whose rotor's vibration is measured.
pub trait HasVibration: Machine {
    /// The rotor that is measured, and how: the motor's shaft, eight turns a block.
    const PHASORS: PhasorSettings = PhasorSettings::DIRECT;
    /// The largest sample of each channel that is not clipped \[unit of the sensors\].
    const VIBRATION_LIMIT: f64;
    /// Base of the samples in fixed point \[unit of the sensors\]: twice the limit.
    const VIBRATION_BASE: f64 = 2.0 * Self::VIBRATION_LIMIT;
}

macro_rules! phasors {
    ($number:ident, $limit:expr) => {
        impl<M: HasVibration, const CHANNELS: usize, const EDGES: usize> Configure<M, $number>
            for Phasors<$number, CHANNELS, EDGES>
        {
            type Config = PhasorsConfig<$number, CHANNELS>;
            const CONFIG: Self::Config = PhasorsConfig::<$number, CHANNELS>::new(&M::PHASORS, [$limit; CHANNELS]);
        }
    };
}

phasors!(f32, M::VIBRATION_LIMIT);
phasors!(f64, M::VIBRATION_LIMIT);
phasors!(Fixed, M::VIBRATION_LIMIT / M::VIBRATION_BASE);
