//! The holes of a plane.

use driveline::balancing::{CorrectionMethod, Entry, Error};

use super::units::AngleConvention;
use super::value::{ABOVE_ZERO, plane};
use crate::machine_file::{Diagnostic, Quantity, Table};

#[derive(Clone, Debug)]
pub struct PlaneHoles {
    pub plane: usize,
    /// Angles (degrees).
    pub degrees: Vec<f64>,
    /// Weights to choose from.
    pub weights: Vec<f64>,
    /// Whether weight is added or removed.
    pub mode: CorrectionMethod,
    /// Message where they cannot take the weight.
    pub too_heavy: Diagnostic,
}

pub(super) fn holes(
    table: &mut Table<'_>,
    planes: &[String],
    convention: AngleConvention,
) -> Result<PlaneHoles, Diagnostic> {
    let plane = plane(table, planes)?;
    let degrees = if table.has("angles") {
        table.instead_of("angles", &["count", "first"])?;
        let items = table.items("angles", "angles in degrees")?;
        let mut degrees: Vec<f64> = Vec::new();
        let mut entry = Entry::new();
        for item in &items {
            let angle = convention.degrees(item.number(Quantity::DEGREES)?);
            entry.polar(1.0, angle);
            if degrees.iter().any(|known| (known - angle).rem_euclid(360.0) == 0.0) {
                return Err(item.wrong("an angle of its own: a hole takes one weight"));
            }
            degrees.push(angle);
        }
        convention.check(&entry).map_err(|refusal| table.wrong("angles", format!("angles in degrees: {refusal}")))?;
        if degrees.is_empty() {
            return Err(table.wrong("angles", "one angle at least"));
        }
        degrees
    } else {
        let count = table.number("count", Quantity::COUNT)? as u32;
        let first = convention.degrees(table.number_or("first", Quantity::DEGREES, 0.0)?);
        (0..count).map(|hole| first + 360.0 * f64::from(hole) / f64::from(count)).collect()
    };
    let items = table.items("weights", "weights to choose from")?;
    let weights = items.iter().map(|item| item.number(ABOVE_ZERO)).collect::<Result<Vec<_>, _>>()?;
    if weights.is_empty() {
        return Err(table.wrong("weights", "one weight at least"));
    }
    let too_heavy = table.wrong("weights", format!("more: {}", Error::TooHeavy { plane }));
    let removing = table.flag_or("removing", false)?;
    Ok(PlaneHoles {
        plane,
        degrees,
        weights,
        too_heavy,
        mode: if removing { CorrectionMethod::Removing } else { CorrectionMethod::Adding },
    })
}
