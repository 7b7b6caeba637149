//! Instructions of a call: the counter read before and after it, less the same round an empty function.

use core::hint::black_box;

use crate::board::Board;

/// A function to be measured: state, input, output.
pub type Measured<S, I, O> = fn(&mut S, &I, &mut O);
/// An observer's step to be measured: constants, state, angle, torque.
pub type Stepped<C, S, N> = fn(&C, &mut S, u32, N);
type Erased = fn(*mut (), *const (), *mut ());

/// Counts instructions on board `B`.
pub struct Counter<'b, B> {
    board: &'b B,
    overhead: u32,
}

impl<'b, B: Board> Counter<'b, B> {
    /// Measures the empty function.
    pub fn new(board: &'b B) -> Self {
        let empty = Counter { board, overhead: 0 };
        let overhead = empty.call(nothing, &mut (), &(), &mut ());
        Counter { board, overhead }
    }

    /// Calls `function` and gives its instructions; the cost of an empty function (frame, return) and of passing the
    /// three pointers is deducted.
    #[inline(always)]
    pub fn call<S, I, O>(&self, function: Measured<S, I, O>, state: &mut S, input: &I, output: &mut O) -> u32 {
        // SAFETY: the same function but for the types behind its pointers, which are thin: the ABI is the same, and its
        // pointers are of the expected types, valid during the call.
        let function = unsafe { core::mem::transmute::<Measured<S, I, O>, Erased>(function) };
        let (state, input, output) = ((&raw mut *state).cast(), (&raw const *input).cast(), (&raw mut *output).cast());
        let counts = timed(self.board, black_box(function), state, input, output);
        B::instructions(counts).wrapping_sub(self.overhead)
    }

    /// Instructions of a function that takes constants, a state, an angle and a number in registers, as an observer's
    /// step does; the cost of an empty function of that kind is deducted.
    #[inline(always)]
    pub fn step<C, S, N: Copy>(
        &self,
        function: Stepped<C, S, N>,
        constants: &C,
        state: &mut S,
        angle: u32,
        number: N,
    ) -> u32 {
        // One closure, one inlined place: the same instructions round both.
        let mut round = |function: Stepped<C, S, N>| {
            timed_step(self.board, black_box(function), constants, &mut *state, angle, number)
        };
        let overhead = B::instructions(round(no_step::<C, S, N>));
        B::instructions(round(function)).wrapping_sub(overhead)
    }

    /// Instructions of the frame round a call, an empty function included.
    pub fn overhead(&self) -> u32 {
        self.overhead
    }
}

/// The one place where a measured call happens: equal instructions round every function.
#[inline(never)]
fn timed<B: Board>(board: &B, function: Erased, state: *mut (), input: *const (), output: *mut ()) -> u32 {
    super::stack::mark();
    let before = board.count();
    function(state, input, output);
    board.count().wrapping_sub(before)
}

/// The one place where a measured step happens.
#[inline(never)]
fn timed_step<B: Board, C, S, N>(
    board: &B,
    function: Stepped<C, S, N>,
    constants: &C,
    state: &mut S,
    angle: u32,
    number: N,
) -> u32 {
    let before = board.count();
    function(constants, state, angle, number);
    board.count().wrapping_sub(before)
}

/// The empty step.
#[inline(never)]
fn no_step<C, S, N>(_: &C, _: &mut S, _: u32, _: N) {}

/// The empty function.
#[inline(never)]
fn nothing(_: &mut (), _: &(), _: &mut ()) {}
