//! Constants of the measurement of the speed's fluctuation.

use super::convert::{get, or_stop};
use super::{Bases, Error};
use crate::fluctuation::{CycleConfig, WaveformConfig};

const RATIO: &str = "the cycle's turns and cycles must be at least 1, and at most 65,535";
const LONG: &str = "the cycle must be at most 16 turns of the motor";
const PERIOD: &str = "the time between two ticks must be positive and finite (s)";
const BINS_SENTENCE: &str =
    "the bins of the waveform must be a power of two, at most 1024, and at least four to each turn of the cycle";
const CYCLES: &str = "the waveform must be taken over at least 1 cycle, and at most 65,535";

/// What repeats: so many turns of the motor to so many cycles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Cycle {
    /// Turns of the motor, at least 1 ...
    pub turns: u32,
    /// ... in this many cycles, at least 1.
    pub cycles: u32,
}

impl Cycle {
    /// One turn of the motor.
    pub const TURN: Cycle = Cycle { turns: 1, cycles: 1 };
    /// Two turns: a four-stroke engine.
    pub const FOUR_STROKE: Cycle = Cycle { turns: 2, cycles: 1 };
}

impl CycleConfig {
    /// The constants of a cycle in ticks of `period` \[s\], for numbers of these bases: [`Bases::SI`] for floats.
    ///
    /// # Panics
    /// At compile time in a constant, with the sentence of the [`Error`] that [`try_new`](Self::try_new) returns.
    pub const fn new(cycle: Cycle, period: f64, bases: Bases) -> Self {
        or_stop!(Self::try_new(cycle, period, bases))
    }

    /// The constants of a cycle in ticks of `period` \[s\], for numbers of these bases: [`Bases::SI`] for floats.
    ///
    /// # Errors
    /// [`Error::Value`] for a ratio of zero or beyond 65,535, a cycle of more than 16 turns, or a period that is not positive and finite.
    pub const fn try_new(cycle: Cycle, period: f64, bases: Bases) -> Result<Self, Error> {
        get!(bases.check());
        let Cycle { turns, cycles } = cycle;
        if turns == 0 || cycles == 0 || turns > 65_535 || cycles > 65_535 {
            return Err(Error::Value(RATIO));
        }
        if turns > 16 * cycles {
            return Err(Error::Value(LONG));
        }
        if !(period > 0.0 && period.is_finite()) {
            return Err(Error::Value(PERIOD));
        }
        // As few segments as keep within a quarter of a turn.
        let mut segments = 1_u32;
        while 4 * turns > segments * cycles {
            segments *= 2;
        }
        let whole = (turns as u64) << 32;
        let parts = cycles as u64 * segments as u64;
        Ok(CycleConfig {
            length: (whole / parts) as u32,
            last_segment: segments - 1,
            remainder: (whole % parts) as u32,
            divisor: cycles,
            angle: core::f64::consts::TAU * turns as f64 / cycles as f64,
            period,
            speed: bases.speed,
            torque: bases.torque,
        })
    }
}

impl WaveformConfig {
    /// The constants of a waveform of `BINS` bins over `cycles` cycles.
    ///
    /// # Panics
    /// At compile time in a constant, with the sentence of the [`Error`] that [`try_new`](Self::try_new) returns.
    pub const fn new<const BINS: usize>(cycle: CycleConfig, cycles: u32) -> Self {
        or_stop!(Self::try_new::<BINS>(cycle, cycles))
    }

    /// The constants of a waveform of `BINS` bins over `cycles` cycles.
    ///
    /// # Errors
    /// [`Error::Value`] for bins that are no power of two or too few for the cycle, or a number of cycles that is zero or beyond 65,535.
    pub const fn try_new<const BINS: usize>(cycle: CycleConfig, cycles: u32) -> Result<Self, Error> {
        let segments = cycle.last_segment as usize + 1;
        if !(BINS.is_power_of_two() && BINS <= 1024 && BINS >= segments && BINS >= 4) {
            return Err(Error::Value(BINS_SENTENCE));
        }
        if cycles == 0 || cycles > 65_535 {
            return Err(Error::Value(CYCLES));
        }
        let per_segment = (BINS / segments) as u32;
        let length = cycle.length as u64;
        let scale = ((per_segment as u64) << 32) / length;
        if scale > u32::MAX as u64 {
            return Err(Error::Value(BINS_SENTENCE));
        }
        Ok(WaveformConfig { cycle, cycles, scale: scale as u32, per_segment })
    }
}
