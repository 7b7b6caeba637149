//! Why a step is not within its bound.

/// Why a step is not within its bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// The format of the number holds no such coefficient: a compile error in a firmware.
    Refused,
    /// The cheap step is too coarse or unstable there, and the design does not choose it.
    NotChosen,
    /// The number's resolution: what moves in a tick is so little that roundings repeat instead of averaging out, or a
    /// unit in the last place is too coarse for what moves.
    Resolution,
    /// The cheap step takes the twist rate as the difference of two speeds that are large against it.
    Cancellation,
    /// The stored coefficients have a pole outside the unit circle, by their rounding.
    Coefficients,
    /// The roundings of the states pump a swing that nothing damps.
    Rounding,
    /// None of these: a fault.
    Unexplained,
}
