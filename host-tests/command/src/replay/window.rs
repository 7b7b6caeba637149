//! Windows of cycles, whatever they are measured by.

use driveline::fluctuation::{Ripple, Unusable};

/// Which cycles make a window.
#[derive(Clone, Copy, Debug)]
pub struct Windows {
    /// Turns to a cycle: 1, or 2 of a four-stroke engine.
    pub turns: u32,
    /// Cycles to a window.
    pub cycles: u32,
    /// Highest order of the cycle.
    pub orders: usize,
}

/// A window of cycles.
#[derive(Clone, Debug)]
pub struct Windowed {
    /// Time at which its last cycle was known to be over \[s\].
    pub until: f64,
    /// Its cycles.
    pub cycles: u32,
    /// Speed and ripple, or why there is none.
    pub ripple: Result<Ripple, Unusable>,
}
