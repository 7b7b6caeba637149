//! Constants of the measurement of the speed's fluctuation.

use super::constants::constants;
use super::{Bases, Error};
use crate::design::{LoopObserver, RigidDesign, TwoMassDesign};
use crate::fluctuation::{CycleConfig, CycleMeanConfig, Drivetrain, PLACES, SpeedErrors, WaveformConfig};
use crate::machine::TwoMass;

const RATIO: &str = "the cycle's turns and cycles must be at least 1, and at most 65,535";
const LONG: &str = "the cycle must be at most 16 turns of the motor";
const PERIOD: &str = "the time between two ticks must be positive and finite (s)";
const BINS_SENTENCE: &str = "the bins of the waveform must be a power of two, at most 1024, at least four to each turn \
    of the cycle, and at most 8192 to a turn";
const SEGMENTS_SENTENCE: &str = "the segments of the cycle's mean must be a power of two from 4 to 1024, none longer \
    than a quarter of a turn of the motor nor shorter than 2^-23 of one";
const SLOW: &str =
    "the motor turns too little in a tick at the base of the speed for a mean in fixed point: lower the rate";
const CYCLES: &str = "the waveform must be taken over at least 1 cycle, and at most 65,535";

/// A cycle: turns of the motor to a number of cycles.
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

impl SpeedErrors {
    /// Errors of an observer of two masses.
    #[must_use]
    pub const fn of(design: &TwoMassDesign) -> Self {
        let noise = [design.standard_deviation.motor_speed, design.standard_deviation.load_speed];
        SpeedErrors { noise, lag: LoopObserver::TwoMass(design).speed_lag() }
    }

    /// Errors of an observer of one mass.
    #[must_use]
    pub const fn of_rigid(design: &RigidDesign) -> Self {
        SpeedErrors { noise: [design.standard_deviation[1]; 2], lag: LoopObserver::Rigid(design).speed_lag() }
    }
}

impl Drivetrain {
    /// The reduced machine.
    pub const fn of(machine: &TwoMass) -> Self {
        Drivetrain {
            motor_inertia: machine.motor_inertia,
            load_inertia: machine.load_inertia,
            stiffness: machine.stiffness,
            damping: machine.damping,
        }
    }
}

impl CycleConfig {
    stops! {
        /// The constants of a cycle in ticks of `period` (s), for numbers of these bases: [`Bases::SI`] for floats.
        pub const fn new(cycle: Cycle, period: f64, bases: Bases) -> Self = try_new
    }

    /// The constants of a cycle in ticks of `period` (s), for numbers of these bases: [`Bases::SI`] for floats.
    ///
    /// # Errors
    /// [`Error::Value`] for a ratio of zero or beyond 65,535, a cycle of more than 16 turns, or a period that is not
    /// positive and finite.
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
        Ok(Self::in_segments(cycle, segments, period, bases))
    }

    const fn in_segments(cycle: Cycle, segments: u32, period: f64, bases: Bases) -> Self {
        let Cycle { turns, cycles } = cycle;
        let whole = (turns as u64) << 32;
        let parts = cycles as u64 * segments as u64;
        CycleConfig {
            length: (whole / parts) as u32,
            last_segment: segments - 1,
            whole: ((whole % parts) / cycles as u64) as u32,
            part: (whole % cycles as u64) as u32,
            divisor: cycles,
            angle: core::f64::consts::TAU * turns as f64 / cycles as f64,
            period,
            speed: bases.speed,
            torque: bases.torque,
        }
    }
}

/// A cycle in so many segments, and its angle (2^-26 turn).
const fn mean_cycle(cycle: Cycle, segments: usize, period: f64, bases: Bases) -> Result<(CycleConfig, u32), Error> {
    let least = get!(CycleConfig::try_new(cycle, period, bases)).last_segment as usize + 1;
    if !(segments.is_power_of_two() && segments >= 4 && segments <= 1024 && segments >= least) {
        return Err(Error::Value(SEGMENTS_SENTENCE));
    }
    let whole = ((cycle.turns as u64) << 26) / cycle.cycles as u64;
    if whole >> 3 < segments as u64 {
        return Err(Error::Value(SEGMENTS_SENTENCE));
    }
    Ok((CycleConfig::in_segments(cycle, segments as u32, period, bases), whole as u32))
}

constants! {
    /// As [`CycleConfig::try_new`], of the speed without its ripple, renewed `SEGMENTS` times a cycle in ticks of
    /// `period` (s). [`Error::Value`] for segments that are no power of two, or too few or too many for the cycle;
    /// [`Error::Coefficient`] in fixed point for a motor that turns by less than a count of 2^-32 turns in a tick at its
    /// base.
    impl[] CycleMeanConfig[], new, try_new<const SEGMENTS: usize>(cycle: Cycle, period: f64), |format| {
        let (cycle, angle) = get!(mean_cycle(cycle, SEGMENTS, period, format.bases));
        let speed = format.speed_of_turn(period);
        // The format ends there, and the speed would come out too low.
        if format.unit != 1.0 && speed > 0.4989 {
            return Err(Error::Coefficient(SLOW));
        }
        Ok(CycleMeanConfig { cycle, angle, speed: get!(To::coefficient(speed, SLOW)) })
    }
}

impl WaveformConfig {
    stops! {
        /// The constants of a waveform of `BINS` bins over `cycles` cycles.
        pub const fn new<const BINS: usize>(cycle: CycleConfig, cycles: u32) -> Self = try_new
    }

    /// The constants of a waveform of `BINS` bins over `cycles` cycles.
    ///
    /// # Errors
    /// [`Error::Value`] for bins that are no power of two or too few for the cycle, or a number of cycles that is zero
    /// or beyond 65,535.
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
        let scale = ((per_segment as u64) << (32 + PLACES)) / length;
        if scale > i32::MAX as u64 {
            return Err(Error::Value(BINS_SENTENCE));
        }
        Ok(WaveformConfig { cycle, cycles, scale: scale as i32, per_segment })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Fixed;

    /// Segments are a power of two, 4 to 1024, each of eight units of 2^-26 turn or more.
    #[test]
    fn segments_of_a_mean_cycle() {
        let made = |turns: u32, cycles: u32, segments: usize| {
            mean_cycle(Cycle { turns, cycles }, segments, 1e-3, Bases::SI).map(|(_, whole)| whole)
        };
        assert_eq!([made(3, 2, 16).unwrap(), made(1, 1, 16).unwrap()], [3 << 25, 1 << 26]);
        let refused = Err(Error::Value(SEGMENTS_SENTENCE));
        for segments in [2, 6, 12, 1000, 2048] {
            assert_eq!(made(1, 1, segments), refused, "{segments}");
        }
        assert!(made(1, 1, 4).is_ok() && made(1, 1, 1024).is_ok());
        // 2^26/2^15 is 2048: 256 segments of eight
        assert_eq!([made(1, 1 << 15, 256), made(1, 1 << 15, 512)], [Ok(2048), refused]);
    }

    /// In fixed point the factor from a turn in a tick to a speed is `2^28/(2^32/tau 2^16 period)` with a base of one:
    /// `tau/2^20` over the period.
    #[test]
    fn a_motor_turns_enough_in_a_tick() {
        let made = |factor: f64| {
            let period = core::f64::consts::TAU / 1_048_576.0 / factor;
            CycleMeanConfig::<Fixed>::try_new::<4>(Cycle::TURN, period, Bases::SI).map(|made| made.speed.to_f64())
        };
        assert!(made(0.4988).is_ok_and(|speed| (speed - 0.4988).abs() < 1e-9));
        assert!(CycleMeanConfig::<f32>::try_new::<4>(Cycle::TURN, 1e-60, Bases::SI).is_err());
        for factor in [0.49895, 0.5, 2.0] {
            assert_eq!(made(factor), Err(Error::Coefficient(SLOW)), "{factor}");
        }
    }
}
