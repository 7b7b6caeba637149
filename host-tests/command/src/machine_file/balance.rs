//! Readings of a balancing that an engineer typed in: a TOML file, read with every fault placed.
//!
//! ```toml
//! name = "fan"
//! unit = "mm/s"                                  # of the readings, as they are shown
//! planes = ["drive end", "free end"]
//! sensors = ["bearing A", "bearing B"]           # one for each reading of a run
//!
//! [baseline]
//! rpm = 1480                                     # or one for each reading
//! readings = [[7.2, 238], [13.5, 296]]           # amplitude, phase in degrees
//!
//! [[trial]]
//! plane = "drive end"
//! weight = [2.5, 0]                              # amount, angle in degrees
//! rpm = 1480
//! readings = [[4.9, 114], [9.2, 347]]
//! ```
//!
//! These keys may be left out:
//!
//! - `weight_unit`: `"g"` (as without it), `"kg"`, `"g mm"`, `"kg m"`, `"oz"`, `"oz in"` or `"lb"`
//! - `angle_unit`: `"degrees"` (as without it, but phases that look like radians are then refused) or `"radians"`
//! - `phase_sense`: `"lead"` (as without it) or `"lag"`, the sense in which phases of readings are counted
//! - `weight_sense`: `"with rotation"` (as without it) or `"against rotation"`, the sense in which angles of weights
//!   are counted
//! - `[run_out]`: `readings` of a slow roll, which are taken off every other reading
//! - `[[split]]`: `plane`, two `angles` that its weight is split between
//! - `trials`: `"removed"` before the next run (as without it), or `"stay"`
//! - `aim`: `"least squares"` (as without it) or `"min-max"`
//! - `good`: the largest residual that is good enough
//! - `independence`: the least share of a plane's effect that must be its own, 0.01
//! - `weighting`: a number for each reading, zero for one that is left out
//! - `limits`: the largest weight of each plane, above zero, or `"none"`
//! - `rpm` of a run: all runs are of one speed without it
//! - `[[correction]]`: `weights` that were put on, an amount and an angle for each plane, then `rpm` and `readings`
//!   with them
//! - `[[influence]]`: `plane` and `coefficients`, an amplitude and phase for each reading, instead of a trial run
//! - `[[holes]]`: `plane`, `angles` or `count` (and `first`), `weights` to choose from, `removing = true` for drilling
//! - `[rotor]`: `mass` (kg), `rpm` in service, `grade` (mm/s), `radius` (m) of the weights
//! - `span`, `centre`, `planes_at` of `[rotor]`: along the rotor from bearing A (m), bearing B, the centre of mass and
//!   each plane; the grade is then split between the bearings
//! - `width`, `diameter` of `[rotor]`: its width and diameter (m), which say whether one plane is enough
//! - `machine`: `"hard-bearing"`, forces (N) in bearings A and B of a balancing machine, whose planes are separated by
//!   their places in `[rotor]`
//! - `[amplitudes]`: `baseline`, `weight`, `runs` of an angle and an amplitude; of one plane, without phases, instead
//!   of `[baseline]`
//!
//! A plane may have several `[[trial]]`: all of them count, by least squares. Where trial weights stay, `weight` is
//! what each run has more than the one before it.

mod amplitudes;
mod file;
mod hard_bearing;
mod holes;
mod phasors;
mod polar;
mod rotor;
mod run;
mod units;
mod value;

use std::path::Path;

pub use file::{BalanceFile, Field, Measured, PLANES, ROWS, TRIALS};
pub use holes::PlaneHoles;
pub use rotor::{Along, Rotor};
pub use units::{AngleConvention, WeightUnit};

use crate::machine_file::read::document;
use crate::machine_file::{Diagnostic, Quantity, Source, Table, text};
use amplitudes::amplitudes;
use holes::holes;
use phasors::phasors;
use rotor::rotor;
use value::{list, names, plane};

/// Reads a balancing from a file.
///
/// # Errors
/// A [`Diagnostic`] with the place, the key, what was found and what was expected.
pub fn read(path: &Path) -> Result<BalanceFile, Diagnostic> {
    let (name, text) = text(path, "a file of balancing")?;
    parse(&name, &text)
}

/// Reads a balancing from a text; `name` is what messages call it.
///
/// # Errors
/// A [`Diagnostic`] with the place, the key, what was found and what was expected.
pub fn parse(name: &str, text: &str) -> Result<BalanceFile, Diagnostic> {
    let source = Source { name, text };
    let document = document(source, "a balancing: `name`, `planes`, [baseline] and [[trial]] tables")?;
    let mut root = Table::root(source, document.get_ref());
    let rotor_name = root.text("name", "the rotor's name")?.to_owned();
    let unit = root.text_if("unit", "the unit of the readings")?.unwrap_or("").to_owned();
    let weight_unit = WeightUnit::read(&mut root)?;
    let convention = AngleConvention::read(&mut root)?;
    let planes = names(&mut root, "planes", PLANES)?;
    let mut file = BalanceFile {
        name: rotor_name,
        unit,
        weight_unit,
        angles: convention,
        sensors: Vec::new(),
        measured: Measured::Nothing,
        holes: Vec::new(),
        splits: Vec::new(),
        rotor: None,
        planes,
    };
    for mut table in root.optional_tables("holes")? {
        let holes = holes(&mut table, &file.planes, convention)?;
        if file.holes.iter().any(|known| known.plane == holes.plane) {
            return Err(table.wrong("plane", "a plane that has no [[holes]] yet: one table for all holes of a plane"));
        }
        file.holes.push(holes);
        table.finish()?;
    }
    for mut table in root.optional_tables("split")? {
        let plane = plane(&mut table, &file.planes)?;
        let angles = list(&mut table, "angles", 2, Quantity::DEGREES)?;
        let apart = |a: f64, b: f64| (convention.degrees(a) - convention.degrees(b)).to_radians().sin().abs();
        let [a, b] = angles[..] else { return Err(table.wrong("angles", "a list of 2 numbers")) };
        // within half a degree of one line
        if apart(a, b) < 0.01 {
            return Err(table.wrong("angles", "two angles that are neither alike nor opposite"));
        }
        if file.splits.iter().any(|known| known.0 == plane) || file.holes.iter().any(|known| known.plane == plane) {
            return Err(table.wrong("plane", "a plane that has neither a [[split]] nor [[holes]] yet"));
        }
        file.splits.push((plane, [convention.degrees(a), convention.degrees(b)]));
        table.finish()?;
    }
    if root.has("rotor") {
        file.rotor = Some(rotor(root.table("rotor")?, file.planes.len(), file.weight_unit)?);
    }
    if root.has("amplitudes") {
        file.measured = amplitudes(&mut root, &file)?;
    } else {
        file.sensors = names(&mut root, "sensors", ROWS)?;
        file.measured = phasors(&mut root, &file)?;
    }
    root.finish()?;
    Ok(file)
}
