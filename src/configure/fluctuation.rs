//! Measurements of the speed's fluctuation for a machine.

use super::{Configure, Machine, Needs};
use crate::fluctuation::{CycleConfig, CycleMean, CycleMeanConfig, Extremes, Interleaved, Waveform, WaveformConfig};
use crate::number::Fixed;
use crate::settings::Bases;

macro_rules! measurements {
    ($number:ident, $bases:expr) => {
        impl<M: Machine> Configure<M, $number> for Extremes {
            type Config = CycleConfig;
            const CONFIG: CycleConfig = CycleConfig::new(M::CYCLE, M::PERIOD, $bases);
            const NEEDS: Needs = Needs { ticks: 96.0, ..Needs::NONE };
        }

        impl<M: Machine, const BINS: usize> Configure<M, $number> for Waveform<BINS> {
            type Config = WaveformConfig;
            const CONFIG: WaveformConfig =
                WaveformConfig::new::<BINS>(CycleConfig::new(M::CYCLE, M::PERIOD, $bases), M::CYCLES);
        }

        impl<M: Machine, const BINS: usize> Configure<M, $number> for Interleaved<BINS> {
            type Config = WaveformConfig;
            const CONFIG: WaveformConfig = <Waveform<BINS> as Configure<M, $number>>::CONFIG;
            const NEEDS: Needs = Needs { ticks: 160.0, ..Needs::NONE };
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
