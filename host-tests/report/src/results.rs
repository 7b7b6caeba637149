//! The figures of a run: what each variant got wrong and what it cost.

use serde::Serialize;

/// Root mean square and largest absolute value of an error, as a fraction: of the peak for a torque, of the rated speed
/// for a speed. A value that is not finite stands for an estimate that diverged; JSON writes it as `null`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Deviation {
    /// Root mean square over the run.
    #[serde(with = "diverged_as_null")]
    pub rms: f64,
    /// Largest absolute value over the run.
    #[serde(with = "diverged_as_null")]
    pub max: f64,
}

/// Instructions of one tick over the inputs of the run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Instructions {
    /// Fewest.
    pub min: u64,
    pub median: u64,
    /// Most of the run's inputs, which is no bound.
    pub max: u64,
}

/// One variant of a scene: how wrong it was and what it cost. The fields are those that `run --json` prints.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Variant {
    /// Number type: `f32` or `fixed`.
    pub number: String,
    /// Core: `m4f` or `m3`.
    pub core: String,
    /// Observer: `rigid`, `cut`, `reduced` and so on.
    pub observer: String,
    /// Control ticks a second.
    pub rate_hz: u32,
    /// Error of the shaft torque, of its peak.
    pub shaft_torque: Deviation,
    /// Error of the load speed, of the rated speed.
    pub load_speed: Deviation,
    /// Error of the load torque, of its peak.
    pub load_torque: Deviation,
    /// Instructions of a tick, counted exactly.
    pub instructions: Instructions,
    /// Least and most cycles of the path with the most, by the core's manual and without wait states; `None` where it
    /// has no bound.
    pub cycles: Option<[u64; 2]>,
    /// Flash of the tick's code and constants.
    pub flash_bytes: u64,
    /// RAM of the drive's state.
    pub ram_bytes: u64,
    /// Deepest stack of the tick.
    pub stack_bytes: u64,
    /// Host and target agreed bit for bit over the whole run.
    pub bit_exact: bool,
    /// Ticks of the run.
    pub ticks: u64,
}

impl Variant {
    /// The variant in a line: `f32 · m4f · reduced · 10 kHz`.
    pub fn label(&self) -> String {
        format!("{} · {} · {} · {}", self.number, self.core, self.observer, super::format::rate(self.rate_hz))
    }
}

/// A budget and what was measured against it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Budget {
    /// Bounded quantity: `instructions, exact step, m4f f32`.
    pub name: String,
    /// Unit of both numbers: `instructions`, `byte`, `%`; empty for a pure number.
    pub unit: String,
    #[serde(with = "diverged_as_null")]
    pub measured: f64,
    /// The most that is allowed.
    pub limit: f64,
}

impl Budget {
    /// Whether the budget is kept; what is not finite is not.
    pub fn kept(&self) -> bool {
        self.measured <= self.limit
    }
}

/// A fact of the machine or the run, as a name and a value with its unit.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Fact {
    pub name: String,
    /// Value with its unit.
    pub value: String,
}

/// The fact of this name.
pub fn fact(name: impl Into<String>, value: String) -> Fact {
    Fact { name: name.into(), value }
}

/// JSON has no infinity: what diverged is `null`.
pub(super) mod diverged_as_null {
    use serde::Serializer;

    pub fn serialize<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
        if value.is_finite() { serializer.serialize_f64(*value) } else { serializer.serialize_none() }
    }
}
