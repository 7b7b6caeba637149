//! Stages of the test.

/// Where the test is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Stage {
    /// The motor stands, the load settles.
    Holding,
    /// Two speeds and the ramps between, both ways.
    Friction,
    /// Turns at the test's speed.
    Encoder,
    /// In both directions against a load held by friction.
    Backlash,
    /// Turning under a multisine.
    Resonance,
    /// The motor stands, there is an answer.
    Done,
    /// The motor stands or is without torque, there is a reason.
    Refused,
}
