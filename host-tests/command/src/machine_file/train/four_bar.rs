//! The bars of a four-bar, and of a toggle before its link.

use driveline_solver::plant::train::{FourBar, Orders};

use crate::machine_file::diagnostic::Diagnostic;
use crate::machine_file::quantity::Quantity;
use crate::machine_file::table::Table;

/// The bars of a four-bar, and what moves with them: masses (kg) on ways (m), inertias (kg m2) on angles (rad).
pub(super) fn four_bar(table: &mut Table<'_>) -> Result<(FourBar, [(f64, Orders); 4]), Diagnostic> {
    let bars = FourBar {
        crank: table.number("crank", Quantity::DIAMETER)?,
        coupler: table.number("coupler", Quantity::DIAMETER)?,
        rocker: table.number("rocker", Quantity::DIAMETER)?,
        ground: table.number("ground", Quantity::DIAMETER)?,
    };
    if !bars.is_crank_rocker() {
        let expected = "the shortest bar, which with the longest one is shorter than the other two together";
        return Err(table.wrong("crank", expected));
    }
    let mass = table.number_or("coupler_mass", Quantity::SIZE, 0.0)?;
    let centre = bars.coupler * table.number_or("coupler_centre", Quantity { most: 1.0, ..Quantity::SIZE }, 0.5)?;
    let coupler_inertia = table.number_or("coupler_inertia", Quantity::SIZE, 0.0)?;
    let rocker_inertia = table.number_or("rocker_inertia", Quantity::SIZE, 0.0)?;
    let [coupler, rocker] = [0, 1].map(|bar| Orders::sampled(|angle| bars.angles(angle)[bar]));
    let x = Orders::sampled(|angle| bars.crank * angle.cos() + centre * bars.angles(angle)[0].cos());
    let y = Orders::sampled(|angle| bars.crank * angle.sin() + centre * bars.angles(angle)[0].sin());
    Ok((bars, [(mass, x), (mass, y), (coupler_inertia, coupler), (rocker_inertia, rocker)]))
}
