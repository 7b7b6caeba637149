//! The measurement of the speed's fluctuation, on a motor that turns at 1425 r/min, a little faster and slower by
//! turns.

use driveline::fluctuation::{
    CycleConfig, CycleMean, CycleMeanConfig, Extremes, Fluctuation, GearMesh, GearMeshConfig, Ranked, Sideband, Summed,
    Waveform, WaveformConfig,
};
use driveline::number::Number;
use driveline::sample::Estimate;
use driveline::settings::{Bases, Cycle};

use super::Bench;
use crate::board::Board;
use crate::self_test::inputs::Program;

/// Bins of the waveform.
const BINS: usize = 64;

/// One tick's angle, torque and estimate.
struct Tick<N> {
    angle: u32,
    torque: N,
    estimate: Estimate<N>,
}

/// A quarter of a turn, so that there are many ends.
pub const QUARTER: Cycle = Cycle { turns: 1, cycles: 4 };

/// Every part alone, and both.
pub fn all<B: Board, N: Ranked + Summed + 'static>(bench: &mut Bench<'_, B>, bases: Bases, mean: CycleMeanConfig<N>) {
    // A window of six cycles is most of the calls.
    let cycle = CycleConfig::new(QUARTER, 1e-4, bases);
    let waveform = WaveformConfig::new::<BINS>(cycle, 6);
    part::<B, N, Extremes<N>>(bench, "fluctuation/extremes", cycle);
    part::<B, N, Waveform<BINS, N>>(bench, "fluctuation/waveform", waveform);
    part::<B, N, (Extremes<N>, Waveform<BINS, N>)>(bench, "fluctuation/both", (cycle, waveform));
    part::<B, N, CycleMean<4, N>>(bench, "fluctuation/cycle-mean", mean);
    // A block every turn, so that its end is among the calls.
    const MESH: GearMeshConfig<2> = GearMeshConfig::new(23, &[Sideband::MESH, Sideband::of_motor(1)], 1);
    part::<B, N, GearMesh<2, 9>>(bench, "fluctuation/gear-mesh", MESH);
}

fn part<B: Board, N: Number, F: Fluctuation<N>>(bench: &mut Bench<'_, B>, name: &str, config: F::Config) {
    let mut angle = 0_u32;
    let mut speed = 10_200_000_u32;
    let input = move |inputs: &mut Program| {
        // The ripple: up for an eighth of a turn, down for the next.
        speed = if angle >> 29 & 1 == 0 { speed.wrapping_add(1_000) } else { speed.wrapping_sub(1_000) };
        angle = angle.wrapping_add(speed);
        let speed = N::from_angle(speed as i32);
        let estimate = Estimate { motor_speed: speed, load_speed: speed, ..Estimate::default() };
        Tick { angle, torque: N::from_word(inputs.next_word()), estimate }
    };
    bench.measure(name, (config, F::default()), input, measure::<N, F>);
}

#[inline(never)]
fn measure<N: Number, F: Fluctuation<N>>(state: &mut (F::Config, F), tick: &Tick<N>, _: &mut ()) {
    state.1.measure(&state.0, tick.angle, tick.torque, &tick.estimate);
}
