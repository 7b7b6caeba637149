//! Dry friction on a coordinate, or between two.

use driveline_solver::plant::train::Friction;

use super::reading::Reading;
use crate::machine_file::diagnostic::Diagnostic;
use crate::machine_file::quantity::Quantity;
use crate::machine_file::table::Table;

impl Reading {
    pub(super) fn friction(&self, mut table: Table<'_>) -> Result<Friction, Diagnostic> {
        let torque = table.number("torque", Quantity::SIZE)?;
        let friction = if table.has("between") {
            table.instead_of("between", &["on"])?;
            let (one, other) = self.pair(&mut table)?;
            Friction::between(one, other, torque)
        } else {
            Friction::ground(self.named(&mut table, "on")?, torque)
        };
        let breakaway = table.number_or("breakaway", Quantity::SIZE, torque)?;
        if breakaway < torque {
            return Err(table.wrong("breakaway", "at least the torque that slides"));
        }
        let surface = table.number_or("surface", Quantity::ANY, 0.0)?;
        table.finish()?;
        Ok(friction.breakaway(breakaway).surface(surface))
    }
}
