//! The names read so far, and how the tables behind them name them.

use std::ops::Range;

use driveline_solver::plant::train::{Crank, FourBar, FourBarPins, Harmonic, Orders, Pins, StrokeLoad};

use crate::machine_file::diagnostic::Diagnostic;
use crate::machine_file::table::Table;

/// The names read so far.
#[derive(Default)]
pub(super) struct Reading {
    pub(super) names: Vec<String>,
    /// Of each coordinate, its speed at the start; those of elements and of gear pairs rest.
    pub(super) speeds: Vec<f64>,
    /// Of each coordinate, the way of the slider (m) or the angle of the rocker (rad) by its own angle.
    pub(super) ways: Vec<Option<Orders>>,
    pub(super) links: Vec<String>,
    pub(super) static_force: Vec<Option<f64>>,
    /// Coordinates whose mechanism rubs.
    pub(super) forwards: Vec<usize>,
    /// Coordinates whose mechanism has friction in its pins.
    pub(super) pins: Vec<(usize, Joints, Range<usize>)>,
    /// Cranks whose pins' forces are wanted, each at an angle (rad).
    pub(super) pins_at: Vec<(usize, Crank, f64)>,
    /// Forces on the slider of a coordinate's crank, or torques on the rocker of its four-bar.
    pub(super) loads: Vec<(usize, StrokeLoad)>,
}

/// Pins with friction.
pub(super) enum Joints {
    Crank(Pins),
    /// With the inertia of the rocker about its pivot, kg m2.
    FourBar(FourBar, f64, FourBarPins),
}

impl Reading {
    /// The coordinate that a key names.
    pub(super) fn named(&self, table: &mut Table<'_>, key: &'static str) -> Result<usize, Diagnostic> {
        let expected = self.known();
        let name = table.text(key, &expected)?;
        self.names.iter().position(|known| known == name).ok_or_else(|| table.wrong(key, expected))
    }

    pub(super) fn known(&self) -> String {
        let quoted: Vec<String> = self.names.iter().map(|name| format!("\"{name}\"")).collect();
        format!("the name of a coordinate: {}", quoted.join(", "))
    }

    /// The two coordinates that `between` names.
    pub(super) fn pair(&self, table: &mut Table<'_>) -> Result<(usize, usize), Diagnostic> {
        let expected = format!("two of them, as [\"{0}\", \"{0}\"]: {1}", "name", self.known());
        let texts = table.texts("between", 2, &expected)?;
        let place = |text: &str| self.names.iter().position(|known| known == text);
        match (place(texts[0]), place(texts[1])) {
            (Some(one), Some(other)) if one != other => Ok((one, other)),
            _ => Err(table.wrong("between", expected)),
        }
    }
}

/// A name that no table before it has.
pub(super) fn fresh(table: &mut Table<'_>, taken: &[String]) -> Result<String, Diagnostic> {
    const NAME: &str = "a name of 1 to 24 printable characters that no other has";
    let name = table.text("name", NAME)?;
    let printable = !name.trim().is_empty() && name.chars().count() <= 24 && !name.chars().any(char::is_control);
    if printable && !taken.iter().any(|other| other == name) {
        Ok(name.to_owned())
    } else {
        Err(table.wrong("name", NAME))
    }
}

pub(super) fn harmonics(table: &mut Table<'_>, key: &'static str) -> Result<Vec<Harmonic>, Diagnostic> {
    let rows = table.rows(key, 3, "rows of [order, cosine, sine]")?;
    Ok(rows.iter().map(|row| Harmonic { order: row[0], cosine: row[1], sine: row[2] }).collect())
}
