//! Windows of cycles, whatever they are measured by.

use driveline::fluctuation::{Order, Ripple, Unusable};

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
    /// Time at which its last cycle was known to be over (s).
    pub until: f64,
    pub cycles: u32,
    /// Speed and ripple, or why there is none.
    pub ripple: Result<Ripple, Unusable>,
    /// Why they are not to be relied on.
    pub doubt: Option<&'static str>,
}

/// Share of a delta that three of its standard deviations are within.
const SHARE: f64 = 0.05;

/// Whether a delta is known well enough to be used.
pub fn is_known(ripple: &Ripple) -> bool {
    3.0 * ripple.motor.deviation <= SHARE * ripple.motor.delta
}

/// A doubt.
pub const DIFFER: &str = "the cycles differ by more than their ripple: a stop, a reversal, another load";

/// Angle by which a good wheel's teeth are out of place (rad): a tenth of a degree, 0.2 mm at a radius of 100 mm.
const TEETH: f64 = 1.75e-3;

/// What speaks against a ripple by the times of teeth, over a cycle of so many turns: its orders explain angles of
/// their own size.
pub fn doubt(ripple: &Ripple, turns: u32) -> Option<&'static str> {
    let angle = |(n, order): (usize, &Order)| order.amplitude() / ripple.speed.mean / (n + 1) as f64;
    let square: f64 = ripple.speed.orders.iter().enumerate().map(angle).map(|angle| 0.5 * angle * angle).sum();
    let explained = (f64::from(turns) * square.sqrt()).max(TEETH);
    if ripple.quality.residue > explained {
        Some("more is left than the orders explain")
    } else if ripple.quality.spread > explained {
        Some(DIFFER)
    } else {
        None
    }
}
