//! Constants of the measurement of a rotor's vibration.

use crate::angle::RotorAngleConfig;
use crate::balancing::{PhasorsConfig, Steadiness};
use crate::number::{Fixed, Number};

/// The rotor that is measured, and how.
///
/// A disturbance that keeps its frequency, as the mains' hum in a sensor's cable, adds nothing over whole beats: at 48
/// turns a second beside 50 Hz take [`turns`](Self::turns) of a multiple of 24.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PhasorSettings {
    /// Turns of the rotor to [`PhasorSettings::motor_turns`] of the motor, negative where it turns against the angle:
    /// the numbers of teeth.
    pub rotor_turns: i32,
    /// Turns of the motor.
    pub motor_turns: u32,
    /// Periods of the vibration on a turn of the rotor, from 1 on.
    pub order: u32,
    /// Turns of the rotor of a block, from 1 on; a reading has one block less than edges.
    pub turns: u32,
    /// Limits of a reading's unsteadiness.
    pub steadiness: Steadiness,
}

impl PhasorSettings {
    /// The rotor on the motor's shaft, its own order, eight turns a block.
    pub const DIRECT: Self =
        PhasorSettings { rotor_turns: 1, motor_turns: 1, order: 1, turns: 8, steadiness: Steadiness::USUAL };
}

sentences! {
    /// A setting of the measurement that is out of its range.
    PhasorError:
    Ratio => "turns of the motor must be 1 to 2^20, turns of the rotor times the order at most 15 times as many",
    Turns => "turns of a block, times the order, must be 1 to 300",
    Limit => "the limit of each channel must be a positive number, in fixed point at most 2",
}

const fn turning(measured: &PhasorSettings) -> Result<(RotorAngleConfig, u32), PhasorError> {
    if measured.order == 0 || measured.order > 64 {
        return Err(PhasorError::Ratio);
    }
    let Some(turns) = measured.rotor_turns.checked_mul(measured.order as i32) else {
        return Err(PhasorError::Ratio);
    };
    let Some(turning) = RotorAngleConfig::new(turns, measured.motor_turns) else {
        return Err(PhasorError::Ratio);
    };
    if measured.turns == 0 || measured.turns > 300 || measured.turns * measured.order > 300 {
        return Err(PhasorError::Turns);
    }
    Ok((turning, measured.turns * measured.order))
}

macro_rules! phasors {
    ($number:ident, $most:expr, |$limit:ident| $convert:expr) => {
        impl<const CHANNELS: usize> PhasorsConfig<$number, CHANNELS> {
            /// The constants of a measurement; `limits` are the ends of the range of each channel (unit of the channel,
            /// per unit of its base in fixed point). A sample there or beyond is clipped, as one within 1e-6 of it.
            ///
            /// # Panics
            /// The sentence of [`PhasorError`]: a compile error in a constant.
            pub const fn new(measured: &PhasorSettings, limits: [f64; CHANNELS]) -> Self {
                match Self::try_new(measured, limits) {
                    Ok(config) => config,
                    Err(error) => panic!("{}", error.message()),
                }
            }

            /// The same at run time.
            ///
            /// # Errors
            /// A parameter out of its range.
            pub const fn try_new(measured: &PhasorSettings, limits: [f64; CHANNELS]) -> Result<Self, PhasorError> {
                let (turning, block) = get!(turning(measured));
                let mut converted = [<$number as Number>::ZERO; CHANNELS];
                each!(channel, 0..CHANNELS, {
                    let $limit = limits[channel];
                    if !($limit > 0.0 && $limit <= $most) {
                        return Err(PhasorError::Limit);
                    }
                    converted[channel] = $convert;
                });
                Ok(PhasorsConfig { turning, block, limits: converted, steadiness: measured.steadiness })
            }
        }
    };
}

/// Share of the end of a range that a sample may reach. Samples and limits are scaled and rounded apart from each
/// other: some 2^-22 in single precision.
const BELOW: f64 = 1.0 - 1e-6;

phasors!(f32, 1e30, |limit| (limit * BELOW) as f32);
phasors!(f64, 1e300, |limit| limit * BELOW);
// a base is 2^28 units: of a small limit they round by more than that share
phasors!(Fixed, 2.0, |limit| Fixed::from_f64((limit * BELOW - 2.0 / 268_435_456.0).max(0.0)));
