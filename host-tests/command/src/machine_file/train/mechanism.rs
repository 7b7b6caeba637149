//! The laws of mechanisms: what moves with the bars of a four-bar, with a toggle, with a cam.

use driveline_solver::plant::train::{FourBar, Harmonic, Orders, Toggle};

use crate::machine_file::diagnostic::Diagnostic;
use crate::machine_file::quantity::Quantity;
use crate::machine_file::table::Table;

/// Masses (kg) on ways (m), inertias (kg m2) on angles (rad).
type Parts = Vec<(f64, Orders)>;

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

/// The slider of a toggle, and what moves with it.
pub(super) fn toggle(table: &mut Table<'_>) -> Result<(Orders, Parts), Diagnostic> {
    let (bars, parts) = four_bar(table)?;
    let link = table.number("link", Quantity::DIAMETER)?;
    if link <= bars.rocker {
        return Err(table.wrong("link", "more than the rocker"));
    }
    let toggle = Toggle { bars, link, direction: table.number("direction", Quantity::DIRECTION)? };
    let slider = Orders::sampled(|angle| toggle.way(angle));
    let moved = (table.number("slider_mass", Quantity::SIZE)?, slider.clone());
    Ok((slider, parts.into_iter().chain([moved]).collect()))
}

/// The follower of a cam, and what moves with it.
pub(super) fn cam(table: &mut Table<'_>) -> Result<(Orders, Parts), Diagnostic> {
    let follower = Orders::of(&even(table, "lift", Quantity::LIFT)?);
    Ok((follower.clone(), vec![(table.number("mass", Quantity::SIZE)?, follower)]))
}

/// The inertia (kg m2) of a mechanism by the angle of its crank.
pub(super) fn inertia(
    table: &Table<'_>,
    key: &str,
    parts: &[(f64, Orders)],
    way: &Orders,
) -> Result<Vec<Harmonic>, Diagnostic> {
    let moved: Vec<(f64, &Orders)> = parts.iter().map(|(mass, way)| (*mass, way)).collect();
    let inertia = Orders::inertia(&moved);
    if [way, &inertia].into_iter().flat_map(|orders| &orders.0).any(|harmonic| harmonic.cosine.is_nan()) {
        let expected = "bars that are not so near to lying in one line: their motion has more than 2,000 orders";
        return Err(table.wrong(key, expected));
    }
    Ok(inertia.0)
}

/// Values at even angles of a turn, the first at zero.
pub(super) fn even(table: &mut Table<'_>, key: &'static str, quantity: Quantity) -> Result<Vec<f64>, Diagnostic> {
    let values = table.numbers(key, quantity)?;
    if values.len() < 3 || values.len() % 2 == 0 || values.len() > 1001 {
        return Err(table.wrong(key, "an odd number of values at even angles of a turn, 3 to 1001"));
    }
    Ok(values)
}

/// The law of a mechanism, and what moves with it.
type Law = fn(&mut Table<'_>) -> Result<(Orders, Parts), Diagnostic>;

/// Mean inertia (kg m2) over a turn of a mechanism in a file of elements, by the keys of train files.
pub(in crate::machine_file) fn mean_inertia(table: &mut Table<'_>) -> Result<f64, Diagnostic> {
    let rocker: Law = |table| {
        let (bars, parts) = four_bar(table)?;
        Ok((Orders::sampled(|angle| bars.angles(angle)[1]), parts.to_vec()))
    };
    let mut laws = Vec::new();
    for (key, blamed, law) in [("four_bar", "crank", rocker), ("toggle", "crank", toggle), ("cam", "lift", cam)] {
        if let Some(mut of) = table.table_if(key)? {
            let (way, parts) = law(&mut of)?;
            laws.push(inertia(&of, blamed, &parts, &way)?);
            of.finish()?;
        }
    }
    if table.has("inertia_table") {
        laws.push(Orders::of(&even(table, "inertia_table", Quantity::SIZE)?).0);
    }
    let [law] = &laws[..] else {
        let expected = "exactly one of `four_bar`, `toggle`, `cam` and `inertia_table` in a mechanism";
        return Err(table.wrong("kind", expected));
    };
    Ok(law.iter().filter(|harmonic| harmonic.order == 0.0).map(|harmonic| harmonic.cosine).sum())
}
