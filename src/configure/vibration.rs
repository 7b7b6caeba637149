//! Measurements of a rotor's vibration for a machine.

use super::{Configure, Machine};
use crate::angle::Synchronous;
use crate::balancing::{Phasors, PhasorsConfig};
use crate::number::Fixed;
use crate::settings::PhasorSettings;

/// A machine whose rotor's vibration is measured.
///
/// ```
#[doc = include_str!("../roll.txt")]
/// use driveline::balancing::{Phasors, PhasorsConfig};
/// use driveline::configure::{Configure, HasVibration};
/// use driveline::settings::PhasorSettings;
/// impl HasVibration for Roll {
///     // velocity, to 20 mm/s; the roll turns twice while the motor turns five times
///     const VIBRATION_LIMIT: f64 = 0.02;
///     const PHASORS: PhasorSettings = PhasorSettings { rotor_turns: 2, motor_turns: 5, ..PhasorSettings::DIRECT };
/// }
/// static ONE_SENSOR: PhasorsConfig<Fixed, 1> = <Phasors<1, 9> as Configure<Roll, Fixed>>::CONFIG;
/// assert_eq!(Roll::VIBRATION_BASE, 0.04); // m/s: a sample in fixed point is per unit of it
/// ```
pub trait HasVibration: Machine {
    /// The rotor that is measured, and how: the motor's shaft, eight turns a block. Its
    /// [`floor`](crate::balancing::Steadiness::floor) is in the unit of the sensors, whatever the number.
    const PHASORS: PhasorSettings = PhasorSettings::DIRECT;
    /// The end of the range of each channel (unit of the sensors): a sample there or beyond is clipped.
    const VIBRATION_LIMIT: f64;
    /// Base of the samples in fixed point (unit of the sensors): twice the limit.
    const VIBRATION_BASE: f64 = 2.0 * Self::VIBRATION_LIMIT;
}

/// A number that vibration is measured in.
pub trait VibrationNumber: Synchronous {
    /// Vibration of one (unit of the sensors).
    fn vibration_unit<M: HasVibration>() -> f32;
}

/// How a channel is measured whose samples are per unit of this base.
const fn per_unit(mut measured: PhasorSettings, base: f64) -> PhasorSettings {
    measured.steadiness.floor = (measured.steadiness.floor as f64 / base) as f32;
    measured
}

macro_rules! phasors {
    ($number:ident, $base:expr) => {
        impl VibrationNumber for $number {
            fn vibration_unit<M: HasVibration>() -> f32 {
                const { $base as f32 }
            }
        }

        impl<M: HasVibration, const CHANNELS: usize, const EDGES: usize> Configure<M, $number>
            for Phasors<CHANNELS, EDGES>
        {
            type Config = PhasorsConfig<$number, CHANNELS>;
            const CONFIG: Self::Config = PhasorsConfig::<$number, CHANNELS>::new(
                &per_unit(M::PHASORS, $base),
                [M::VIBRATION_LIMIT / $base; CHANNELS],
            );
        }
    };
}

phasors!(f32, 1.0);
phasors!(f64, 1.0);
phasors!(Fixed, M::VIBRATION_BASE);
