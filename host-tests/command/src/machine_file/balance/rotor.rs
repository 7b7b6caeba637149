//! The rotor: its mass, its grade, and where everything is along it.

use driveline::balancing::one_plane_suffices;

use super::units::WeightUnit;
use super::value::list;
use crate::machine_file::{Diagnostic, Quantity, Table};

#[derive(Clone, Debug)]
pub struct Rotor {
    /// Mass (kg).
    pub mass: f64,
    /// Highest service speed (rpm).
    pub rpm: f64,
    /// Balance quality grade (mm/s).
    pub grade: f64,
    /// Radius of the weights (m).
    pub radius: Option<f64>,
    /// Where everything is along the rotor.
    pub along: Option<Along>,
    /// Whether one plane is enough, by width over diameter.
    pub one_plane: Option<bool>,
}

/// Places along a rotor, from bearing A.
#[derive(Clone, Debug)]
pub struct Along {
    /// Bearing B (m).
    pub span: f64,
    /// Centre of mass (m).
    pub centre: f64,
    /// Each plane (m).
    pub planes: Vec<f64>,
}

/// Reads `[rotor]`; `unit` is that of the weights.
pub(super) fn rotor(mut table: Table<'_>, planes: usize, unit: WeightUnit) -> Result<Rotor, Diagnostic> {
    let radius = if table.has("radius") { Some(table.number("radius", Quantity::DIAMETER)?) } else { None };
    if radius.is_none() && unit.unbalance(None).is_none() {
        return Err(table.wrong("radius", format!("the radius of the weights, which are in {}", unit.name())));
    }
    let rotor = Rotor {
        along: along(&mut table, planes)?,
        one_plane: one_plane(&mut table)?,
        mass: table.number("mass", Quantity::MASS)?,
        rpm: table.number("rpm", Quantity::RPM)?,
        grade: table.number("grade", Quantity::GRADE)?,
        radius,
    };
    table.finish()?;
    Ok(rotor)
}

/// Places along the rotor, all of them or none.
fn along(table: &mut Table<'_>, planes: usize) -> Result<Option<Along>, Diagnostic> {
    if !["span", "centre", "planes_at"].into_iter().any(|key| table.has(key)) {
        return Ok(None);
    }
    let (span, centre) = (table.number("span", Quantity::LENGTH)?, table.number("centre", Quantity::PLACE)?);
    if !table.has("planes_at") {
        return Err(table.wrong("planes_at", format!("a list of {planes} places from bearing A")));
    }
    Ok(Some(Along { span, centre, planes: list(table, "planes_at", planes, Quantity::PLACE)? }))
}

/// Whether a rotor of this width and diameter is balanced in one plane.
fn one_plane(table: &mut Table<'_>) -> Result<Option<bool>, Diagnostic> {
    let given = (table.number_if("width", Quantity::LENGTH)?, table.number_if("diameter", Quantity::DIAMETER)?);
    if given == (None, None) {
        return Ok(None);
    }
    let (width, diameter) = (table.number("width", Quantity::LENGTH)?, table.number("diameter", Quantity::DIAMETER)?);
    one_plane_suffices(width, diameter).map(Some).map_err(|refusal| table.wrong("width", refusal.to_string()))
}
