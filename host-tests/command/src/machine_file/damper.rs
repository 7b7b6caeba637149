//! Dampers on masses of the machine.

use driveline::machine::{Damper, Inertia, Resonance};

use super::diagnostic::Diagnostic;
use super::engine::Turning;
use super::quantity::Quantity;
use super::table::Table;

/// A ring beside one of the machine's masses, sized for a mode.
#[derive(Clone, Debug, PartialEq)]
pub struct DamperRing {
    /// Label of the mass.
    pub at: String,
    /// Index of the mass.
    pub mass: usize,
    /// The motor's speed over that of the mass.
    pub ratio: f64,
    /// Whether it has a spring.
    pub tuned: bool,
    /// Inertia on its own shaft (kg m2).
    pub inertia: f64,
    /// Mode that it damps, from 0.
    pub mode: usize,
    /// Stiffness (N m/rad) and damping (N m s/rad) on its own shaft, where the file has them.
    stiffness: Option<f64>,
    damping: Option<f64>,
}

impl DamperRing {
    /// Reads `[[damper]]` tables; `masses` are those that they can stand on, `modes` the number of modes.
    pub(super) fn read_all(root: &mut Table<'_>, masses: &[Turning], modes: usize) -> Result<Vec<Self>, Diagnostic> {
        root.tables_if("damper", "damper")?.into_iter().map(|(_, table)| Self::read(table, masses, modes)).collect()
    }

    fn read(mut table: Table<'_>, masses: &[Turning], modes: usize) -> Result<Self, Diagnostic> {
        const KINDS: &str = "\"tuned\" or \"viscous\"";
        let tuned = match table.text("kind", KINDS)? {
            "tuned" => true,
            "viscous" => false,
            _ => return Err(table.wrong("kind", KINDS)),
        };
        let known = masses.iter().map(|(label, ..)| format!("\"{label}\"")).collect::<Vec<_>>().join(", ");
        let expected = format!("the label of one mass that turns: {known}");
        let at = table.text("at", &expected)?.to_owned();
        let mut labelled = masses.iter().filter(|(label, ..)| *label == at);
        let (Some(&(_, mass, ratio)), None) = (labelled.next(), labelled.next()) else {
            return Err(table.wrong("at", expected));
        };
        // `COUNT` allows whole numbers up to 360 only
        let mode = table.number_or("mode", Quantity::COUNT, 1.0)? as usize;
        if mode > modes {
            return Err(table.wrong("mode", format!("a mode of the machine, 1 to {modes}")));
        }
        let ring = Self {
            at,
            mass,
            ratio,
            tuned,
            inertia: table.number("inertia", Quantity::INERTIA)?,
            mode: mode - 1,
            stiffness: if tuned { table.number_if("stiffness", Quantity::STIFFNESS)? } else { None },
            damping: table.number_if("damping", Quantity::DAMPING)?,
        };
        table.finish()?;
        Ok(ring)
    }

    /// The damper at the motor, for the resonance of its mode: the best one, with the file's sizes in its place.
    pub fn sized(&self, main: &Resonance) -> Damper {
        let square = self.ratio * self.ratio;
        let ring = Inertia(self.inertia / square);
        let best = if self.tuned { main.tuned_damper(ring) } else { main.viscous_damper(ring) };
        Damper {
            stiffness: self.stiffness.map_or(best.stiffness, |stiffness| stiffness / square),
            damping: self.damping.map_or(best.damping, |damping| damping / square),
            ..best
        }
    }
}
