//! A link: its ends, its losses, and how the stiffness of its mesh changes.

use driveline_solver::plant::train::{Link, Teeth, Variation};

use super::reading::{Reading, fresh, harmonics};
use crate::machine_file::diagnostic::Diagnostic;
use crate::machine_file::element::signed_ratio;
use crate::machine_file::quantity::Quantity;
use crate::machine_file::table::Table;

impl Reading {
    pub(super) fn link(&mut self, mut table: Table<'_>) -> Result<Link, Diagnostic> {
        let name = fresh(&mut table, &self.links)?;
        let stiffness = table.number("stiffness", Quantity::SPRING)?;
        let mut link = if table.has("ground") {
            table.instead_of("ground", &["terms", "between", "ratio"])?;
            Link::ground(self.named(&mut table, "ground")?, stiffness)
        } else if table.has("terms") {
            table.instead_of("terms", &["between", "ratio"])?;
            let expected = format!("shares of the elongation, each under {}", self.known());
            let place = |text: &str| self.names.iter().position(|known| known == text);
            let terms = table.shares("terms", Quantity::ANY, &expected, place)?;
            Link::new(&terms, stiffness)
        } else {
            let (one, other) = self.pair(&mut table)?;
            let ratio = if table.has("ratio") { signed_ratio(&mut table)? } else { 1.0 };
            Link::geared(one, other, ratio, stiffness)
        };
        let efficiency = table.number_or("efficiency", Quantity::EFFICIENCY, 1.0)?;
        link = link
            .damping(table.number_or("damping", Quantity::DAMPER, 0.0)?)
            .gap(table.number_or("gap", Quantity::SIZE, 0.0)?)
            .efficiency(efficiency)
            .back_efficiency(table.number_or("back_efficiency", Quantity::BACK_EFFICIENCY, efficiency)?)
            .elongated(table.number_or("elongation", Quantity::ANY, 0.0)?);
        if table.flag_or("rope", false)? {
            link = link.rope();
        }
        if let Some(variation) = self.variation(&mut table)? {
            link = link.varying(variation);
        }
        let held = if table.has("static") { Some(table.number("static", Quantity::ANY)?) } else { None };
        table.finish()?;
        self.links.push(name);
        self.static_force.push(held);
        Ok(link)
    }

    /// How the stiffness of a mesh changes: `spur`, `teeth` or `harmonics`.
    pub(super) fn variation(&self, table: &mut Table<'_>) -> Result<Option<Variation>, Diagnostic> {
        let given: Vec<_> = ["spur", "teeth", "harmonics"].into_iter().filter(|&key| table.has(key)).collect();
        if let [_, second, ..] = given[..] {
            return Err(table.wrong(second, "one of `spur`, `teeth` and `harmonics`"));
        }
        let mut found = None;
        if let Some(mut spur) = table.table_if("spur")? {
            let (contact, [double, leaving, single], errors) = pairs(&mut spur)?;
            let frequency = spur.number("frequency", Quantity::FREQUENCY)?;
            found = Some(Variation::pairs(contact, frequency, [double, leaving], single, errors));
            spur.finish()?;
        }
        if let Some(mut mesh) = table.table_if("teeth")? {
            let (contact_ratio, [double, leaving, single], errors) = pairs(&mut mesh)?;
            found = Some(Variation::Teeth(Teeth {
                coordinate: self.named(&mut mesh, "of")?,
                count: mesh.number("count", Quantity { whole: true, least: 1.0, ..Quantity::ORDER })?,
                contact_ratio,
                double,
                single,
                leaving,
                errors,
            }));
            mesh.finish()?;
        }
        if let Some(mut swing) = table.table_if("harmonics")? {
            let frequency = swing.number("frequency", Quantity::FREQUENCY)?;
            let stiffness = if swing.has("stiffness") { harmonics(&mut swing, "stiffness")? } else { Vec::new() };
            let error = if swing.has("error") { harmonics(&mut swing, "error")? } else { Vec::new() };
            found = Some(Variation::Harmonics { frequency, stiffness, error });
            swing.finish()?;
        }
        Ok(found)
    }
}

/// Contact ratio of a mesh; stiffness of both pairs, of the one that leaves, and of one pair alone; errors of one pair
/// and the next.
fn pairs(table: &mut Table<'_>) -> Result<(f64, [f64; 3], [f64; 2]), Diagnostic> {
    let contact = table.number("contact_ratio", Quantity { least: 1.0, most: 2.0, ..Quantity::RATIO })?;
    if contact <= 1.0 || contact >= 2.0 {
        return Err(table.wrong("contact_ratio", "a number between 1 and 2"));
    }
    let [double, single] = if table.has("face_width") {
        table.instead_of("face_width", &["double", "single"])?;
        of_teeth(table)?
    } else {
        [table.number("double", Quantity::SPRING)?, table.number("single", Quantity::SPRING)?]
    };
    let leaving = table.number_or("leaving", Quantity::SPRING, 0.5 * double)?;
    if leaving > double {
        return Err(table.wrong("leaving", "at most `double`, the stiffness of both pairs"));
    }
    let errors = [table.number_or("error", Quantity::ANY, 0.0)?, table.number_or("next_error", Quantity::ANY, 0.0)?];
    Ok((contact, [double, leaving, single], errors))
}

/// Stiffness of two pairs and of one pair of steel spur teeth along the line of action (N/m): `c' b`, with
/// `c' = 0.8/q'` in N/(mm um) [ISO 6336-1:2006 method B]. Two pairs have 1.75 times the stiffness of one, so that the
/// mean over the mesh is the standard's `c' (0.75 epsilon + 0.25)` at every contact ratio [derived].
fn of_teeth(table: &mut Table<'_>) -> Result<[f64; 2], Diagnostic> {
    let width = table.number("face_width", Quantity::LENGTH)?;
    let [z1, z2] = table.pair("tooth_numbers", Quantity::TEETH)?;
    let [x1, x2] = if table.has("shift") { table.pair("shift", Quantity::ANY)? } else { [0.0; 2] };
    if x1 < x2 || !(-0.5..=2.0).contains(&(x1 + x2)) {
        return Err(table.wrong("shift", "the larger shift first, together between -0.5 and 2, as the formula asks"));
    }
    let compliance = 0.047_23 + 0.155_51 / z1 + 0.257_91 / z2
        - 0.006_35 * x1
        - 0.116_54 * x1 / z1
        - 0.001_93 * x2
        - 0.241_88 * x2 / z2
        + 0.005_29 * x1 * x1
        + 0.001_82 * x2 * x2;
    let single = 0.8e9 / compliance * width;
    Ok([1.75 * single, single])
}
