//! What the bench measures: a line a function, with its state, its inputs and the function.

use driveline::constants::Bases;
use driveline::number::Fixed;

use super::Bench;
use super::calibration::{ten_nops, thousand_nops};
use super::{advice, correction, cranked, fluctuation, governors, phasors, steps};
use crate::Words;
use crate::board::Board;
use crate::measure::driveline_tick;
use crate::program::Program;
use crate::scene::Scene;
use crate::scenes::hoist::BASES;
use crate::selected::Selected;

/// Measures everything.
pub fn run<B: Board>(bench: &mut Bench<'_, B>) {
    bench.measure("nops/10", (), |_| (), ten_nops);
    bench.measure("nops/1000", (), |_| (), thousand_nops);
    bench.measure("tick", Selected::new(), Program::next_input, driveline_tick);
    match const { Words::of::<Selected>() } {
        Words::Single => {
            steps::single(bench);
            cranked::single(bench);
            phasors::single(bench);
            fluctuation::all::<B, f32>(bench, Bases::SI);
            governors::single(bench);
        }
        Words::Fixed => {
            steps::fixed(bench);
            cranked::fixed(bench);
            phasors::fixed(bench);
            fluctuation::all::<B, Fixed>(bench, BASES);
            governors::fixed(bench);
        }
    }
    correction::solves(bench);
    correction::accuracy(bench);
    advice::all(bench);
}
