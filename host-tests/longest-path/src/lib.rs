//! Upper bounds of a function from its machine code: instructions on the longest path, and bytes of stack.
//!
//! - **Longest path**: the most instructions that a call can execute, its callees included. Every branch is taken to go
//!   both ways whatever was decided before, so the bound may lie above the worst case, never below it.
//! - **Instruction**: one of Thumb, as QEMU counts them: one that an `IT` block skips counts too, and so does the `IT`.
//! - **Turns** of a loop: how often its first instruction is executed for each entry into the loop. A loop must have
//!   them stated ([`Loops`]); a jump table is read from the code.
//! - **Cycles**: an interval for each instruction and the one before it, by the manuals' rules and by measurements
//!   ([`Cycles`]), and what a flash memory adds ([`Flash`]). The path with the most is sought for itself: it need not be
//!   the longest.
//! - **Stack**: bytes between the stack pointer at the call and its lowest value, callees included.
//!
//! A function that cannot be bounded is refused with the place and the reason ([`Refusal`]): a call or jump through a
//! register, recursion, a loop without stated turns or with two entries, a stack pointer that is computed.
//!
//! Assumed: functions return to their caller, as the procedure call standard demands (Arm IHI 0042), and no exception
//! is taken. Encodings are those of the Armv7-M manual (Arm DDI 0403E).
//!
//! Of an instruction its length, its effect on the program counter and on the stack pointer and its registers are
//! decoded. A disassembler is not needed for it: `capstone` takes a C compiler and a minute of processor time to build.

mod bound;
mod code;
mod cycles;
mod flash;
mod graph;
mod instruction;
mod loops;
mod neighbours;
mod operands;
mod path;
mod refusal;

pub use bound::{Bound, Bounds, Loops};
pub use code::{Code, Function, NotReadable};
pub use cycles::{Core, Cycles};
pub use flash::{Flash, loaded_words};
pub use instruction::{Flow, Instruction, Stack};
pub use path::Piece;
pub use refusal::Refusal;
