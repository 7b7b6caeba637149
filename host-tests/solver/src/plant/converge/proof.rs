//! Result of a run's proof.

/// Largest deviation that a reference run may show, as a share of the peak.
pub const BOUND: f64 = 1e-8;

/// A deviation between two runs, as a share of the peak of its quantity over the run (of all speeds, of each shaft's
/// torque).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Deviation {
    /// The largest over all ticks and quantities.
    pub largest: f64,
    /// Where it was found, s.
    pub time: f64,
}

/// Results of the two checks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Proof {
    /// Against the second integrator.
    pub integrator: Deviation,
    /// Against the solver with its events located ten times closer; none of a run without events.
    pub tightened: Option<Deviation>,
    /// Of a run whose deviations grow beyond [`BOUND`]: it is proven in pieces.
    pub sensitive: Option<Sensitive>,
}

impl Proof {
    /// The larger deviation of the checks.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.tightened.map_or(0.0, |tightened| tightened.largest).max(self.integrator.largest)
    }
}

/// A run in which roundings grow: it is one of many that its start could have become. A check that lost it went on
/// from its own state, so that each piece is proven, and not that the pieces belong to the start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensitive {
    /// Up to here, s, the run is proven from its start.
    pub from: f64,
    /// How often the check that was lost most often went on.
    pub restarts: usize,
    /// The shortest time in which a rounding grew beyond the bound, s.
    pub shortest: f64,
}

/// Why a run does not stand.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NotProven {
    /// A check came out otherwise.
    #[error("the run deviates by {found:.1e} of peak from {from} at {time} s: expected at most {expected:.0e}")]
    Deviates {
        /// Which check.
        from: &'static str,
        /// The deviation over the peak.
        found: f64,
        /// What it may be.
        expected: f64,
        /// Where, s.
        time: f64,
    },
    /// The second integrator gave up.
    #[error("the second integrator failed at {time} s: {reason}")]
    Integrator {
        /// Where, s.
        time: f64,
        /// Its output.
        reason: String,
    },
    /// Nothing was recorded.
    #[error("the recording holds no tick")]
    Empty,
}
