//! What the bench measures: a line a function, with its state, its inputs and the function.

use super::Bench;
use super::calibration::{ten_nops, thousand_nops};
use super::{correction, phasors, steps};
use crate::Words;
use crate::board::Board;
use crate::measure::driveline_tick;
use crate::program::Program;
use crate::scene::Scene;
use crate::selected::Selected;

/// Measures everything.
pub fn run<B: Board>(bench: &mut Bench<'_, B>) {
    bench.measure("nops/10", (), |_| (), ten_nops);
    bench.measure("nops/1000", (), |_| (), thousand_nops);
    bench.measure("tick", Selected::new(), Program::next_input, driveline_tick);
    match const { Words::of::<Selected>() } {
        Words::Single => {
            steps::single(bench);
            phasors::single(bench);
        }
        Words::Fixed => {
            steps::fixed(bench);
            phasors::fixed(bench);
        }
    }
    correction::solves(bench);
    correction::accuracy(bench);
}
