//! Measurements of the speed's fluctuation for a machine.

use super::{Configure, Machine, Needs};
use crate::fluctuation::{
    CycleConfig, CycleMean, CycleMeanConfig, Extremes, GearMesh, GearMeshConfig, Interleaved, Sideband, Waveform,
    WaveformConfig,
};
use crate::number::Fixed;
use crate::settings::Bases;

/// A machine whose motor's shaft carries a gear that is watched.
///
/// ```
#[doc = include_str!("../roll.txt")]
/// use driveline::configure::HasGearMesh;
/// use driveline::fluctuation::{GearMesh, Sideband};
/// impl HasGearMesh<3> for Roll {
///     const TEETH: u32 = 23;
///     const MESH: [Sideband; 3] = [Sideband::MESH, Sideband::of_motor(-1), Sideband::of_motor(1)];
/// }
/// type Watched = Drive<f32, TwoMassObserver, SpeedLoop, GearMesh<3, 9>>; // eight blocks a reading
/// static CONFIG: ConfigOf<Watched> = Watched::configure::<Roll>();
/// let mut drive = Watched::new(&CONFIG, 0);
/// // between the ticks; the first call begins
/// assert!(drive.fluctuation_mut().take(&CONFIG.fluctuation).is_none());
/// ```
pub trait HasGearMesh<const LINES: usize>: Machine {
    /// Teeth on the motor's shaft, 1 to 500.
    const TEETH: u32;
    /// The lines of the mesh's spectrum that are read, one after the other.
    const MESH: [Sideband; LINES];
    /// Least turns of the motor in a block.
    const MESH_TURNS: u32 = 8;
}

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

        impl<M: HasGearMesh<LINES>, const LINES: usize, const EDGES: usize> Configure<M, $number>
            for GearMesh<LINES, EDGES>
        {
            type Config = GearMeshConfig<LINES>;
            const CONFIG: Self::Config = GearMeshConfig::new(M::TEETH, &M::MESH, M::MESH_TURNS);
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
