//! Table of the bench: a line a function, with its state, its inputs and the function.

use driveline::configure::Machine;
use driveline::fluctuation::CycleMeanConfig;
use driveline::number::Fixed;
use driveline::settings::Bases;

use super::Bench;
use super::calibration::{ten_nops, thousand_nops};
use super::{advice, correction, fluctuation, governors, mechanism, phasors, steps, wheel};
use crate::Words;
use crate::board::Board;
use crate::measure::count::Measured;
use crate::scene::{Input, Output, Variant};
use crate::scenes::hoist::Hoist;
use crate::self_test::inputs::Program;

/// Measures everything; `tick` is that of variant `V`.
pub fn run<V: Variant, B: Board>(bench: &mut Bench<'_, B>, tick: Measured<V::Scene, Input, Output>) {
    bench.measure("nops/10", (), |_| (), ten_nops);
    bench.measure("nops/1000", (), |_| (), thousand_nops);
    bench.measure("tick", V::start(), Program::next_input, tick);
    match const { Words::of::<V>() } {
        Words::Single => {
            steps::single(bench);
            mechanism::single(bench);
            phasors::single(bench);
            fluctuation::all::<B, f32>(
                bench,
                Bases::SI,
                CycleMeanConfig::<f32>::new::<4>(fluctuation::QUARTER, 1e-4, Bases::SI),
            );
            governors::single(bench);
        }
        Words::Fixed => {
            steps::fixed(bench);
            mechanism::fixed(bench);
            phasors::fixed(bench);
            const BASES: Bases = Hoist::<10_000>::BASES;
            let mean = CycleMeanConfig::<Fixed>::new::<4>(fluctuation::QUARTER, 1e-4, BASES);
            fluctuation::all::<B, Fixed>(bench, BASES, mean);
            governors::fixed(bench);
        }
    }
    wheel::all(bench);
    correction::solves(bench);
    correction::accuracy(bench);
    advice::all(bench);
    // the instructions of Armv6-M, which has no such atomics, are fewer
    #[cfg(target_has_atomic = "32")]
    super::kernels::all(bench);
}
