//! What the bench measures: a line a function, with its state, its inputs and the function.

use driveline::fluctuation::CycleMeanConfig;
use driveline::number::Fixed;
use driveline::settings::Bases;

use super::Bench;
use super::calibration::{ten_nops, thousand_nops};
use super::{advice, correction, cranked, fluctuation, governors, phasors, steps};
use crate::Words;
use crate::board::Board;
use crate::measure::count::Measured;
use crate::scene::{Input, Output, Scene};
use crate::scenes::hoist::BASES;
use crate::self_test::inputs::Program;

/// Measures everything; `tick` is that of scene `S`.
pub fn run<S: Scene, B: Board>(bench: &mut Bench<'_, B>, tick: Measured<S, Input, Output>) {
    bench.measure("nops/10", (), |_| (), ten_nops);
    bench.measure("nops/1000", (), |_| (), thousand_nops);
    bench.measure("tick", S::new(), Program::next_input, tick);
    match const { Words::of::<S>() } {
        Words::Single => {
            steps::single(bench);
            cranked::single(bench);
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
            cranked::fixed(bench);
            phasors::fixed(bench);
            let mean = CycleMeanConfig::<Fixed>::new::<4>(fluctuation::QUARTER, 1e-4, BASES);
            fluctuation::all::<B, Fixed>(bench, BASES, mean);
            governors::fixed(bench);
        }
    }
    correction::solves(bench);
    correction::accuracy(bench);
    advice::all(bench);
}
