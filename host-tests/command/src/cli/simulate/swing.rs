//! The energy swing of a steady cycle, and the flywheel that a class of machine wants.

use driveline::fluctuation::MachineClass;
use driveline_report::format::significant;
use driveline_report::{Section, Table};
use driveline_solver::plant::train::{Cycle, Motion};
use serde::Serialize;

/// Steps of a cycle between which extremes are those of a parabola.
const STEPS: u32 = 4096;

/// Halvings of the range of a flywheel, to the rounding of its inertia.
const HALVINGS: usize = 60;

const CLASSES: [(&str, MachineClass); 9] = [
    ("crusher", MachineClass::Crusher),
    ("press", MachineClass::Press),
    ("farm machine", MachineClass::Farm),
    ("machine tool", MachineClass::MachineTool),
    ("vehicle", MachineClass::Vehicle),
    ("marine engine", MachineClass::MarineEngine),
    ("compressor", MachineClass::Compressor),
    ("combustion engine", MachineClass::CombustionEngine),
    ("generator", MachineClass::Generator),
];

/// Kinetic energy over a steady cycle.
#[derive(Clone, Debug, Serialize)]
pub struct Swing {
    /// A_max, the swing of the kinetic energy of all coordinates (J).
    pub energy: f64,
    /// Inertia at the coordinate (kg m2), by all kinetic energy: the least and the greatest.
    pub inertia: [f64; 2],
    /// The classes of machine.
    pub classes: Vec<Class>,
}

/// A class of machine with its permissible delta.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Class {
    /// Name.
    pub name: &'static str,
    /// Permissible delta, of the strictest and of the most tolerant machine.
    pub permissible: [f64; 2],
    /// Inertia that is missing at the coordinate (kg m2), for each.
    pub missing: [f64; 2],
}

impl Swing {
    /// Of a motion at the beginning of its steady cycle.
    ///
    /// A flywheel m beside the inertia J(phi) takes part in the energy: with the work over the cycle as it is, `w^2`
    /// becomes `(J w^2 + m w_m^2)/(J + m)`, w_m the mean speed, and delta half of its swing over `w_m^2` \[derived\].
    pub fn of(mut motion: Motion, at: usize, cycle: &Cycle) -> Self {
        let (mut energies, mut inertias) = (Vec::new(), Vec::new());
        for _ in 0..=STEPS {
            let (energy, speed) = (motion.kinetic_energy(), motion.speed(at));
            inertias.push(2.0 * energy / (speed * speed));
            energies.push(energy);
            motion.advance(cycle.time / f64::from(STEPS));
        }
        let speed = 0.5 * (cycle.greatest + cycle.least);
        let square = speed * speed;
        let with = |flywheel: f64| {
            let squares = energies.iter().zip(&inertias).map(|(e, j)| (2.0 * e + flywheel * square) / (j + flywheel));
            0.5 * range(&squares.collect::<Vec<_>>()) / square
        };
        let off =
            energies.iter().zip(&inertias).map(|(energy, j)| (2.0 * energy - j * square).abs()).fold(0.0, f64::max);
        let missing = |delta: f64| {
            let (mut low, mut high) = (0.0, off / (delta * square));
            for _ in 0..if with(0.0) > delta { HALVINGS } else { 0 } {
                let middle = 0.5 * (low + high);
                if with(middle) > delta { low = middle } else { high = middle }
            }
            low
        };
        let class = |(name, class): (&'static str, MachineClass)| {
            let permissible = class.permissible();
            Class { name, permissible, missing: permissible.map(missing) }
        };
        let most = inertias.iter().copied().fold(0.0, f64::max);
        let least = inertias.iter().copied().fold(f64::INFINITY, f64::min);
        Self { energy: range(&energies), inertia: [least, most], classes: CLASSES.map(class).to_vec() }
    }

    /// The table of the classes, beside delta.
    pub fn table(&self, delta: f64) -> Section {
        let mut table = Table::new(["class", "permissible delta", "missing flywheel kg m²", "remedy"]);
        for class in &self.classes {
            let [strict, tolerant] = class.permissible;
            let remedy = match delta {
                delta if delta <= strict => "none",
                delta if delta <= tolerant => "a flywheel for the strictest",
                _ => "a flywheel",
            };
            table.row([
                class.name.to_owned(),
                format!("1/{} to 1/{}", (1.0 / strict).round(), (1.0 / tolerant).round()),
                format!("{} to {}", significant(class.missing[1]), significant(class.missing[0])),
                remedy.to_owned(),
            ]);
        }
        let text = format!(
            "The kinetic energy swings by {} J over the cycle; the inertia at the coordinate is {} to {} kg m². A \
             flywheel mends a swing within the cycle. A governor mends a change from cycle to cycle, which a steady \
             cycle has not.",
            significant(self.energy),
            significant(self.inertia[0]),
            significant(self.inertia[1])
        );
        Section::new("Flywheel for the cycle", text, table)
    }
}

/// The greatest less the least, each of a parabola through three values.
fn range(values: &[f64]) -> f64 {
    let (mut least, mut most) = (values[0], values[0]);
    for three in values.windows(3) {
        let (bend, rise) = (three[0] - 2.0 * three[1] + three[2], 0.5 * (three[2] - three[0]));
        let inside = rise.abs() < bend.abs();
        let end = if inside { three[1] - 0.5 * rise * rise / bend } else { three[1] };
        (least, most) = (least.min(end), most.max(end));
    }
    most - least
}
