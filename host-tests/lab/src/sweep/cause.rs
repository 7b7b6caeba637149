//! Why a step is not within its bound.

/// Why a step is not within its bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
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

impl Cause {
    /// The cause in words, for a criterion.
    pub const fn words(self) -> &'static str {
        match self {
            Cause::Refused => "the format holds no such coefficient (a compile error in a firmware)",
            Cause::NotChosen => "the design does not choose this step there",
            Cause::Resolution => "the number's resolution (too few units in the last place move in a tick)",
            Cause::Cancellation => "the twist rate drowns in the speeds that it is the difference of",
            Cause::Coefficients => "rounded coefficients put a pole outside the unit circle",
            Cause::Rounding => "roundings of the states pump a swing that nothing damps",
            Cause::Unexplained => "unexplained",
        }
    }
}

/// How many points failed from which cause, in a sentence; empty where none failed.
pub fn summary(causes: impl Iterator<Item = Option<Cause>>) -> String {
    let mut failed: Vec<Cause> = causes.flatten().collect();
    failed.sort();
    let groups: Vec<String> =
        failed.chunk_by(|a, b| a == b).map(|group| format!("{} where {}", group.len(), group[0].words())).collect();
    if groups.is_empty() { String::new() } else { format!(" Failed: {}.", groups.join("; ")) }
}
