//! The bench: instructions (on a board with a counter of cycles, those) of single functions, each over many inputs, one
//! line of JSON a function.

mod advice;
mod calibration;
mod correction;
mod cranked;
mod fluctuation;
mod governors;
#[cfg(target_has_atomic = "32")]
mod kernels;
mod phasors;
mod steps;
mod table;
mod wheel;

pub use table::run;

use driveline::number::Number;

use crate::Words;
use crate::board::Board;
use crate::board::json_line::Line;
use crate::measure::count::{Counter, Measured, Stepped};
use crate::measure::stack;
use crate::self_test::fingerprint::SEED;
use crate::self_test::inputs::Program;

/// Calls of each function; odd, so that the median is one of them.
const CALLS: usize = 1001;
/// Calls of a long function; odd too.
const LONG_CALLS: usize = 15;

/// Measures functions one by one.
pub struct Bench<'b, B> {
    board: &'b B,
    counter: Counter<'b, B>,
    variant: &'static str,
    inputs: Program,
}

impl<'b, B: Board> Bench<'b, B> {
    /// A bench on `board` for the image's `variant`, its inputs drawn from `inputs`.
    pub fn new(board: &'b B, variant: &'static str, inputs: Program) -> Self {
        Bench { board, counter: Counter::new(board), variant, inputs }
    }

    /// Calls `function` with one state and fresh inputs, and prints the least, the middle and the most instructions.
    pub fn measure<S, I, O: Default>(
        &mut self,
        name: &str,
        mut state: S,
        mut input: impl FnMut(&mut Program) -> I,
        function: Measured<S, I, O>,
    ) {
        let mut inputs = self.inputs.clone();
        let mut output = O::default();
        let mut counts = [0; CALLS];
        for count in &mut counts {
            *count = self.counter.call(function, &mut state, &input(&mut inputs), &mut output);
        }
        self.print(name, function as usize, &counts);
    }

    /// Calls an observer's step with one state and fresh angles and torques.
    pub fn measure_step<C, S, N: Number>(
        &mut self,
        name: &str,
        constants: &C,
        mut state: S,
        mut input: impl FnMut(&mut Program) -> (u32, N),
        step: Stepped<C, S, N>,
    ) {
        let mut inputs = self.inputs.clone();
        let mut counts = [0; CALLS];
        for count in &mut counts {
            let (angle, torque) = input(&mut inputs);
            *count = self.counter.step(step, constants, &mut state, angle, torque);
        }
        self.print(name, step as usize, &counts);
    }

    /// Calls a long function a few times, with inputs of the given number, and prints its stack too.
    pub fn measure_long<I, O: Default>(
        &mut self,
        name: &str,
        words: Words,
        mut input: impl FnMut(&mut Program) -> I,
        function: Measured<(), I, O>,
    ) {
        let mut inputs = Program::new(SEED, words);
        let mut output = O::default();
        let mut counts = [0; LONG_CALLS];
        stack::paint();
        for count in &mut counts {
            *count = self.counter.call(function, &mut (), &input(&mut inputs), &mut output);
        }
        let used = stack::used();
        self.board.print(self.line(name, function as usize, &counts).number("stack", used).finish());
    }

    /// Prints another quantity than instructions: its name, object, unit and value.
    pub fn print_number(&self, what: &str, of: &str, unit: &str, number: u32) {
        let mut line = Line::new().text(what, of).text("board", B::FACTS.name).number(unit, number);
        self.board.print(line.finish());
    }

    fn print(&self, name: &str, function: usize, counts: &[u32]) {
        self.board.print(self.line(name, function, counts).finish());
    }

    /// The line of a function at an address, where the host finds its machine code.
    fn line(&self, name: &str, function: usize, counts: &[u32]) -> Line {
        let least = counts.iter().fold(u32::MAX, |least, &count| least.min(count));
        let most = counts.iter().fold(0, |most, &count| most.max(count));
        Line::new()
            .text("bench", name)
            .text("variant", self.variant)
            .text("board", B::FACTS.name)
            .number("min", least)
            .number("median", median(counts))
            .number("max", most)
            .number("calls", counts.len() as u32)
            .number("function", function as u32)
            .text("unit", B::UNIT)
    }
}

/// The middle value: at most half of the values are smaller, and at most half greater.
fn median(counts: &[u32]) -> u32 {
    let half = counts.len() / 2;
    let is_middle = |&&value: &&u32| {
        let smaller = counts.iter().filter(|&&other| other < value).count();
        let greater = counts.iter().filter(|&&other| other > value).count();
        smaller <= half && greater <= half
    };
    counts.iter().find(is_middle).copied().unwrap_or(0)
}
