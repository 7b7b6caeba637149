//! Measurements of the speed's fluctuation for a machine.

use super::{Configure, Machine};
use crate::fluctuation::{CycleConfig, CycleMean, CycleMeanConfig, Extremes, Interleaved, Waveform, WaveformConfig};
use crate::number::Fixed;
use crate::settings::Bases;

macro_rules! measurements {
    ($number:ident, $bases:expr) => {
        impl<M: Machine> Configure<M, $number> for Extremes<$number> {
            type Config = CycleConfig;
            const CONFIG: CycleConfig = CycleConfig::new(M::CYCLE, M::PERIOD, $bases);
        }

        impl<M: Machine, const BINS: usize> Configure<M, $number> for Waveform<$number, BINS> {
            type Config = WaveformConfig;
            const CONFIG: WaveformConfig =
                WaveformConfig::new::<BINS>(CycleConfig::new(M::CYCLE, M::PERIOD, $bases), M::CYCLES);
        }

        impl<M: Machine, const BINS: usize> Configure<M, $number> for Interleaved<$number, BINS> {
            type Config = WaveformConfig;
            const CONFIG: WaveformConfig = <Waveform<$number, BINS> as Configure<M, $number>>::CONFIG;
        }

        impl<M: Machine, const SEGMENTS: usize> Configure<M, $number> for CycleMean<$number, SEGMENTS> {
            type Config = CycleMeanConfig<$number>;
            const CONFIG: Self::Config = CycleMeanConfig::<$number>::new::<SEGMENTS>(M::CYCLE, M::PERIOD, $bases);
        }
    };
}

measurements!(f32, Bases::SI);
measurements!(f64, Bases::SI);
measurements!(Fixed, M::BASES);
