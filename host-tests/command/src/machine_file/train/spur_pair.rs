//! A spur pair on shafts and bearings, which is fourteen coordinates and thirteen links.

use driveline_solver::plant::train::{Coordinate, Link, SpurBearing, SpurPair, SpurWheel};

use super::reading::{Reading, fresh};
use crate::machine_file::diagnostic::Diagnostic;
use crate::machine_file::quantity::Quantity;
use crate::machine_file::table::Table;

impl Reading {
    /// A spur pair on shafts and bearings: its fourteen coordinates and thirteen links.
    pub(super) fn spur_pair(&mut self, mut table: Table<'_>) -> Result<(Vec<Coordinate>, Vec<Link>), Diagnostic> {
        let name = fresh(&mut table, &self.links)?;
        let first = self.names.len();
        if let Some(taken) = self.names.iter().find(|other| {
            let own = |wheel: &str| other.strip_prefix(&format!("{name} {wheel}")).is_some();
            own("pinion") || own("wheel")
        }) {
            return Err(table.wrong("name", format!("a name that no coordinate has in its own: `{taken}`")));
        }
        for wheel in ["pinion", "wheel"] {
            let body = format!("{name} {wheel}");
            let bearings = [1, 2].map(|bearing| ["Y", "X"].map(|way| format!("{body} bearing {bearing} {way}")));
            self.names.extend([format!("{body} Y"), format!("{body} X"), body]);
            self.names.extend(bearings.into_iter().flatten());
        }
        self.ways.resize(self.names.len(), None);
        let [pinion, wheel] = ["pinion", "wheel"].map(|key| table.table(key).and_then(spur_wheel));
        let pair = SpurPair {
            pinion: pinion?,
            wheel: wheel?,
            mesh_stiffness: table.number("mesh_stiffness", Quantity::BEARING)?,
            mesh_damping: table.number_or("mesh_damping", Quantity::BEARING_DAMPING, 0.0)?,
            variation: self.variation(&mut table)?,
            gap: table.number_or("gap", Quantity::BORE, 0.0)?,
            torque: 0.0,
        };
        table.finish()?;
        self.links.push(name.clone());
        for wheel in ["pinion", "wheel"] {
            self.links.extend(["Y", "X"].map(|way| format!("{name} {wheel} shaft {way}")));
            let bearings =
                [1, 2].map(|bearing| ["Y", "X"].map(|way| format!("{name} {wheel} bearing {bearing} {way}")));
            self.links.extend(bearings.into_iter().flatten());
        }
        let (coordinates, links) = pair.parts(first);
        self.static_force.resize(self.static_force.len() + links.len(), None);
        Ok((coordinates, links))
    }
}

/// A wheel of a spur pair with its shaft and its bearings.
fn spur_wheel(mut table: Table<'_>) -> Result<SpurWheel, Diagnostic> {
    let two = |table: &mut Table<'_>, key: &'static str, quantity: Quantity| {
        let values = table.numbers(key, quantity)?;
        <[f64; 2]>::try_from(values).map_err(|_| table.wrong(key, "two numbers, one for each bearing"))
    };
    let two_or = |table: &mut Table<'_>, key: &'static str| {
        if table.has(key) { two(table, key, Quantity::BEARING_DAMPING) } else { Ok([0.0; 2]) }
    };
    let (masses, levers) =
        (two(&mut table, "bearing_mass", Quantity::MASS)?, two(&mut table, "lever", Quantity::LENGTH)?);
    let stiffness =
        [two(&mut table, "stiffness_y", Quantity::BEARING)?, two(&mut table, "stiffness_x", Quantity::BEARING)?];
    let damping = [two_or(&mut table, "damping_y")?, two_or(&mut table, "damping_x")?];
    let wheel = SpurWheel {
        mass: table.number("mass", Quantity::MASS)?,
        inertia: table.number("inertia", Quantity::INERTIA)?,
        base_radius: table.number("base_radius", Quantity::DIAMETER)?,
        shaft_stiffness: table.number("shaft_stiffness", Quantity::BEARING)?,
        shaft_damping: table.number_or("shaft_damping", Quantity::BEARING_DAMPING, 0.0)?,
        bearings: [0, 1].map(|bearing| SpurBearing {
            mass: masses[bearing],
            lever: levers[bearing],
            stiffness: stiffness.map(|both| both[bearing]),
            damping: damping.map(|both| both[bearing]),
        }),
    };
    table.finish()?;
    Ok(wheel)
}
