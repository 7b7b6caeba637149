//! The energy swing of a steady cycle, and the flywheel that a class of machine wants.

use driveline::design::flywheel_inertia;
use driveline::fluctuation::MachineClass;
use driveline_report::format::significant;
use driveline_report::{Section, Table};
use driveline_solver::plant::train::{Cycle, Motion};
use serde::Serialize;

/// Steps of a cycle between which extremes are those of a parabola.
const STEPS: u32 = 4096;

/// Relative change of the inertia over a cycle above which it counts as one that varies.
const EVEN: f64 = 1e-3;

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
    /// Inertia that is missing at the coordinate (kg m2), for each; `null` where the inertia varies with the angle.
    pub missing: Option<[f64; 2]>,
}

impl Swing {
    /// Of a motion at the beginning of its steady cycle.
    pub fn of(mut motion: Motion, at: usize, cycle: &Cycle) -> Self {
        let (mut energies, mut inertia) = (Vec::new(), [f64::INFINITY, 0.0_f64]);
        for _ in 0..=STEPS {
            let (energy, speed) = (motion.kinetic_energy(), motion.speed(at));
            let here = 2.0 * energy / (speed * speed);
            inertia = [inertia[0].min(here), inertia[1].max(here)];
            energies.push(energy);
            motion.advance(cycle.time / f64::from(STEPS));
        }
        let (mut least, mut most) = (energies[0], energies[0]);
        for three in energies.windows(3) {
            let (bend, rise) = (three[0] - 2.0 * three[1] + three[2], 0.5 * (three[2] - three[0]));
            let inside = rise.abs() < bend.abs();
            let end = if inside { three[1] - 0.5 * rise * rise / bend } else { three[1] };
            (least, most) = (least.min(end), most.max(end));
        }
        let energy = most - least;
        let speed = 0.5 * (cycle.greatest + cycle.least);
        let is_even = inertia[1] - inertia[0] < EVEN * inertia[1];
        let class = |(name, class): (&'static str, MachineClass)| {
            let permissible = class.permissible();
            let missing = |delta: f64| (flywheel_inertia(energy, speed, delta) - inertia[1]).max(0.0);
            Class { name, permissible, missing: is_even.then(|| permissible.map(missing)) }
        };
        Self { energy, inertia, classes: CLASSES.map(class).to_vec() }
    }

    /// The table of the classes, beside delta.
    pub fn table(&self, delta: f64) -> Section {
        let mut table = Table::new(["class", "permissible delta", "missing flywheel kg m²", "remedy"]);
        for class in &self.classes {
            let [strict, tolerant] = class.permissible;
            let missing = class.missing.map_or_else(
                || "inertia varies".to_owned(),
                |[strict, tolerant]| format!("{} to {}", significant(tolerant), significant(strict)),
            );
            let remedy = match delta {
                delta if delta <= strict => "none",
                delta if delta <= tolerant => "a flywheel for the strictest",
                _ => "a flywheel",
            };
            table.row([
                class.name.to_owned(),
                format!("1/{} to 1/{}", (1.0 / strict).round(), (1.0 / tolerant).round()),
                missing,
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
