//! Interface of the binaries to a board: its counter, its console, and the link of a control loop.

use super::facts::Facts;
use crate::scene::{Input, Output};

/// Interface of the binaries to a board.
pub trait Board {
    /// The host's data on it.
    const FACTS: Facts;
    /// Object of its counts: `instructions` or `cycles`.
    const UNIT: &'static str;
    /// The way in and out of a control loop.
    type Link: Link;

    /// Starts the counter.
    fn start() -> Self;
    /// A free-running 32-bit counter that goes up.
    fn count(&self) -> u32;
    /// Instructions (or cycles, on a board that has no exact count of them) in a difference of counts.
    fn instructions(counts: u32) -> u32;
    /// Opens the link of a control loop; `None` where there is none.
    fn open_link(&self) -> Option<Self::Link>;
    /// Prints a line, its end included.
    fn print(&self, line: &[u8]);
    /// Ends the run, with success or without.
    fn exit(&self, success: bool) -> !;
}

/// The way in and out of a control loop, in lock-step.
pub trait Link {
    /// Waits for the next input; false at the end of the run.
    fn receive(&self, input: &mut Input) -> bool;
    /// Sends an output; false where the other side has gone.
    fn send(&self, output: &Output) -> bool;
}
