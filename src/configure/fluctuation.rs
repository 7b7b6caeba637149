//! Measurements of the speed's fluctuation for a machine.

use core::f64::consts::TAU;

use super::{Configure, Machine};
use crate::fluctuation::{CycleConfig, CycleMean, CycleMeanConfig, Extremes, Interleaved, Waveform, WaveformConfig};
use crate::number::Fixed;
use crate::settings::Bases;

/// Stops a constant where a cycle, or a turn of a longer one, has fewer ticks at rated speed.
const fn has_ticks<M: Machine>(least: f64) {
    let turns = M::CYCLE.turns as f64 / M::CYCLE.cycles as f64;
    let ticks = turns.min(1.0) * TAU / (M::RATING.speed.0 * M::PERIOD);
    assert!(
        !(ticks < least),
        "at rated speed a cycle has fewer than 96 ticks, or 160 beside a waveform, the least for its extremes: raise \
        the rate, or measure the waveform alone"
    );
}

macro_rules! measurements {
    ($number:ident, $bases:expr) => {
        impl<M: Machine> Configure<M, $number> for Extremes {
            type Config = CycleConfig;
            const CONFIG: CycleConfig = {
                has_ticks::<M>(96.0);
                CycleConfig::new(M::CYCLE, M::PERIOD, $bases)
            };
        }

        impl<M: Machine, const BINS: usize> Configure<M, $number> for Waveform<BINS> {
            type Config = WaveformConfig;
            const CONFIG: WaveformConfig =
                WaveformConfig::new::<BINS>(CycleConfig::new(M::CYCLE, M::PERIOD, $bases), M::CYCLES);
        }

        impl<M: Machine, const BINS: usize> Configure<M, $number> for Interleaved<BINS> {
            type Config = WaveformConfig;
            const CONFIG: WaveformConfig = {
                has_ticks::<M>(160.0);
                <Waveform<BINS> as Configure<M, $number>>::CONFIG
            };
        }

        impl<M: Machine, const SEGMENTS: usize> Configure<M, $number> for CycleMean<SEGMENTS> {
            type Config = CycleMeanConfig<$number>;
            const CONFIG: Self::Config = CycleMeanConfig::<$number>::new::<SEGMENTS>(M::CYCLE, M::PERIOD, $bases);
        }
    };
}

measurements!(f32, Bases::SI);
measurements!(f64, Bases::SI);
measurements!(Fixed, M::BASES);
