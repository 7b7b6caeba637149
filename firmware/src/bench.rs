//! The bench: instructions (on a board with a counter of cycles, those) of single functions, each over many inputs, one
//! line of JSON a function.

mod advice;
mod calibration;
mod correction;
mod fluctuation;
mod governors;
#[cfg(target_has_atomic = "32")]
mod kernels;
mod mechanism;
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

/// Calls of a function; odd, so that the median is one of them.
const CALLS: usize = 1001;
/// Calls of a long function; odd too.
const LONG_CALLS: usize = 15;

/// Instruction counts of a function's calls, `KEPT` of them.
struct Counts<const KEPT: usize> {
    kept: [u32; KEPT],
    calls: u32,
    least: u32,
    most: u32,
}

impl<const KEPT: usize> Counts<KEPT> {
    fn new() -> Self {
        Counts { kept: [0; KEPT], calls: 0, least: u32::MAX, most: 0 }
    }

    fn add(&mut self, count: u32) {
        if let Some(place) = self.kept.get_mut(self.calls as usize) {
            *place = count;
        }
        self.calls += 1;
        self.least = self.least.min(count);
        self.most = self.most.max(count);
    }

    /// The middle value of those that are kept: at most half of them are smaller, and at most half greater.
    fn median(&self) -> u32 {
        let kept = self.kept.get(..self.calls as usize).unwrap_or(&self.kept);
        let half = kept.len() / 2;
        let is_middle = |&&value: &&u32| {
            let smaller = kept.iter().filter(|&&other| other < value).count();
            let greater = kept.iter().filter(|&&other| other > value).count();
            smaller <= half && greater <= half
        };
        kept.iter().find(is_middle).copied().unwrap_or(0)
    }
}

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
        let mut counts = Counts::<CALLS>::new();
        for _ in 0..CALLS {
            counts.add(self.counter.call(function, &mut state, &input(&mut inputs), &mut output));
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
        let mut counts = Counts::<CALLS>::new();
        for _ in 0..CALLS {
            let (angle, torque) = input(&mut inputs);
            counts.add(self.counter.step(step, constants, &mut state, angle, torque));
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
        let mut counts = Counts::<LONG_CALLS>::new();
        stack::paint();
        for _ in 0..LONG_CALLS {
            counts.add(self.counter.call(function, &mut (), &input(&mut inputs), &mut output));
        }
        let used = stack::used();
        self.board.print(self.line(name, function as usize, &counts).number("stack", used).finish());
    }

    /// Prints another quantity than instructions: its name, object, unit and value.
    pub fn print_number(&self, what: &str, of: &str, unit: &str, number: u32) {
        let mut line = Line::new().text(what, of).text("board", B::FACTS.name).number(unit, number);
        self.board.print(line.finish());
    }

    fn print<const KEPT: usize>(&self, name: &str, function: usize, counts: &Counts<KEPT>) {
        self.board.print(self.line(name, function, counts).finish());
    }

    /// The line of a function at an address, where the host finds its machine code.
    fn line<const KEPT: usize>(&self, name: &str, function: usize, counts: &Counts<KEPT>) -> Line {
        Line::new()
            .text("bench", name)
            .text("variant", self.variant)
            .text("board", B::FACTS.name)
            .number("min", counts.least)
            .number("median", counts.median())
            .number("max", counts.most)
            .number("calls", counts.calls)
            .number("function", function as u32)
            .text("unit", B::UNIT)
    }
}
