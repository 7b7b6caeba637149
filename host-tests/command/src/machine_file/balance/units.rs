//! The unit of the weights, and how angles are counted.

use driveline::balancing::{Complex, Entry, Error};

use super::value::choice;
use crate::machine_file::{Diagnostic, Table};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WeightUnit {
    /// g.
    Gram,
    /// kg.
    Kilogram,
    /// g mm.
    GramMillimetre,
    /// kg m.
    KilogramMetre,
    /// Avoirdupois ounce.
    Ounce,
    /// oz in.
    OunceInch,
    /// lb.
    Pound,
}

/// kg of an ounce, and m of an inch, both by definition.
const OUNCE: f64 = 0.028_349_523_125;
const INCH: f64 = 0.025_4;

impl WeightUnit {
    /// All, as they are written.
    const ALL: [(&'static str, Self); 7] = [
        ("g", Self::Gram),
        ("kg", Self::Kilogram),
        ("g mm", Self::GramMillimetre),
        ("kg m", Self::KilogramMetre),
        ("oz", Self::Ounce),
        ("oz in", Self::OunceInch),
        ("lb", Self::Pound),
    ];

    /// As the file has it.
    pub(super) fn read(root: &mut Table<'_>) -> Result<Self, Diagnostic> {
        choice(root, "weight_unit", &Self::ALL)
    }

    /// As it is written.
    pub fn name(self) -> &'static str {
        Self::ALL.into_iter().find(|(_, unit)| *unit == self).map_or("", |(name, _)| name)
    }

    /// Unbalance of a weight of one (kg m); none where that takes a radius which is not given.
    pub fn unbalance(self, radius: Option<f64>) -> Option<f64> {
        match self {
            Self::Gram => radius.map(|radius| radius * 1e-3),
            Self::Kilogram => radius,
            Self::GramMillimetre => Some(1e-6),
            Self::KilogramMetre => Some(1.0),
            Self::Ounce => radius.map(|radius| radius * OUNCE),
            Self::OunceInch => Some(OUNCE * INCH),
            Self::Pound => radius.map(|radius| radius * 16.0 * OUNCE),
        }
    }
}

/// How angles are counted in a file, and shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AngleConvention {
    /// Whether the unit is named; if not, phases that look like radians are refused.
    named: bool,
    /// Radians and not degrees.
    pub radians: bool,
    /// Phases of readings lag.
    lag: bool,
    /// Angles of weights are counted against the rotation.
    against: bool,
}

impl AngleConvention {
    /// As the file has it.
    pub(super) fn read(root: &mut Table<'_>) -> Result<Self, Diagnostic> {
        Ok(Self {
            named: root.has("angle_unit"),
            radians: choice(root, "angle_unit", &[("degrees", false), ("radians", true)])?,
            lag: choice(root, "phase_sense", &[("lead", false), ("lag", true)])?,
            against: choice(root, "weight_sense", &[("with rotation", false), ("against rotation", true)])?,
        })
    }

    /// An angle of the file in degrees.
    pub(super) fn degrees(self, angle: f64) -> f64 {
        if self.radians { angle.to_degrees() } else { angle }
    }

    /// The sense in which angles of weights and phases of readings run, in words.
    pub const fn senses(self) -> [&'static str; 2] {
        let weights = if self.against { "against rotation" } else { "with rotation" };
        [weights, if self.lag { "phase lags" } else { "phase leads" }]
    }

    /// A reading from the file, or for it: its own inverse.
    pub fn reading(self, z: Complex<f64>) -> Complex<f64> {
        if self.lag { z.conj() } else { z }
    }

    /// A weight from the file, or for it.
    pub fn weight(self, z: Complex<f64>) -> Complex<f64> {
        if self.against { z.conj() } else { z }
    }

    pub(super) fn check(self, entry: &Entry) -> Result<(), Error> {
        if self.named { Ok(()) } else { entry.check() }
    }
}
