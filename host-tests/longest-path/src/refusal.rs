//! Why a function has no bound.

/// Why a function has no bound, and where.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// No code with that name or at that address.
    #[error("no function is at {at:#x}; an image with its symbols is needed")]
    NoFunction {
        /// The address.
        at: u32,
    },
    /// Code that is none: constants, or bytes outside of the program.
    #[error(
        "{function}: there is no code at {at:#x}, where execution comes; the symbols $t and $d must say where it is"
    )]
    NoCode {
        function: String,
        /// The address.
        at: u32,
    },
    /// A call or jump through a register or memory.
    #[error(
        "{function}: the jump or call at {at:#x} goes to an address that is computed; call the function by its name"
    )]
    Indirect {
        function: String,
        /// The instruction.
        at: u32,
    },
    /// A branch into another function, not to its beginning.
    #[error("{function}: the branch at {at:#x} goes to {target:#x}, which is inside another function")]
    IntoFunction {
        function: String,
        /// The instruction.
        at: u32,
        target: u32,
    },
    /// A function that calls itself, directly or through others.
    #[error("{function} calls itself through the call at {at:#x}; a bound needs a depth of calls that is known")]
    Recursion {
        function: String,
        /// The call that closes the circle.
        at: u32,
    },
    #[error(
        "{function}: loop {index} at {at:#x} has no stated turns; state the most that it can take, with the reason"
    )]
    Loop {
        function: String,
        /// The loop's first instruction.
        at: u32,
        /// Its number among the function's loops, by address, from zero.
        index: usize,
    },
    /// A loop that is entered at two places.
    #[error("{function}: the loop round {at:#x} is entered at two places; turns cannot be counted")]
    Irreducible {
        function: String,
        /// One of them.
        at: u32,
    },
    /// A function without the loop for which turns are stated.
    #[error("{function} has {found} loops, but turns are stated for {stated}; state them again")]
    NoSuchLoop {
        function: String,
        /// Its loops.
        found: usize,
        /// Loops with stated turns.
        stated: usize,
    },
    /// An instruction that the core does not have.
    #[error("{function}: the core has no instruction as that at {at:#x}; name the core that the image is for")]
    OtherCore {
        function: String,
        /// The instruction.
        at: u32,
    },
    /// A stack pointer that is not known.
    #[error("{function}: the stack pointer after {at:#x} is not known: it is computed, or depends on the path taken")]
    Stack {
        function: String,
        /// The instruction.
        at: u32,
    },
}
