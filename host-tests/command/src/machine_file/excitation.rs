//! Excitations and speed range of a machine.

use super::diagnostic::Diagnostic;
use super::quantity::Quantity;
use super::table::Table;

/// Name of the engine's excitation in the diagram of critical speeds.
pub const ENGINE: &str = "engine";

/// The running range, speeds of the motor (rad/s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Running {
    pub least: f64,
    pub greatest: f64,
}

/// Something that excites a fixed number of times on a turn of its shaft.
#[derive(Clone, Debug, PartialEq)]
pub struct Excitation {
    pub name: String,
    /// Speed of the motor over that of the shaft that excites.
    pub ratio: f64,
    /// Times per turn of that shaft: 1/2, 1, 3/2 ... of a four-stroke engine, the teeth of a gear.
    pub orders: Vec<f64>,
}

/// Reads `[running]` and `[[excitation]]`, both of which may be left out.
pub(super) fn excitations(root: &mut Table<'_>) -> Result<(Option<Running>, Vec<Excitation>), Diagnostic> {
    let running = match root.table_if("running")? {
        None => None,
        Some(mut table) => {
            let (least, greatest) =
                (table.number("least", Quantity::SPEED)?, table.number("greatest", Quantity::SPEED)?);
            if greatest < least {
                return Err(table.wrong("greatest", "a speed not below the least"));
            }
            table.finish()?;
            Some(Running { least, greatest })
        }
    };
    let mut all = Vec::new();
    for (_, mut table) in root.tables_if("excitation", "excitation")? {
        const NAME: &str = "a name of 1 to 24 printable characters";
        let name = table.text("name", NAME)?;
        if name.trim().is_empty() || name.chars().count() > 24 || name.chars().any(char::is_control) {
            return Err(table.wrong("name", NAME));
        }
        if name == ENGINE && root.has("engine") {
            return Err(table.wrong("name", "another name than \"engine\", that of the orders of `[engine]`"));
        }
        all.push(Excitation {
            name: name.to_owned(),
            ratio: table.number_or("ratio", Quantity::RATIO, 1.0)?,
            orders: table.numbers("orders", Quantity::ORDER)?,
        });
        table.finish()?;
    }
    Ok((running, all))
}
