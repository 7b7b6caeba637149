//! Dampers: their best size, and the machine's response with and without them.

use std::f64::consts::TAU;

use driveline::machine::{Mode, Resonance};
use serde::Serialize;

use super::response::Response;
use crate::machine_file::{DamperRing, MachineFile};
use driveline_report::format::significant;
use driveline_report::{Section, Table};

/// A damper and what it does, alone.
#[derive(Clone, Debug, Serialize)]
pub struct Damped {
    /// Label of its mass.
    pub at: String,
    /// `tuned` or `viscous`.
    pub kind: &'static str,
    /// Mode that it damps, from 1.
    pub mode: usize,
    /// Frequency of that mode (Hz).
    pub hz: f64,
    /// Inertia of the ring over that of the mode at the mass.
    pub mass_ratio: f64,
    /// Stiffness on its own shaft (N m/rad); 0 of a viscous one.
    pub stiffness: f64,
    /// Damping on its own shaft (N m s/rad).
    pub damping: f64,
    /// Amplitude over the static angle in the fixed points, of one mass with the best damper.
    pub fixed_amplitude: f64,
    /// Largest angle of the mass per torque on it, from half to twice the frequency, both at the motor
    /// (rad/(N m)); `null` where no damping limits it.
    pub without: Option<f64>,
    /// The same with the damper.
    pub with: Option<f64>,
}

/// The machine's dampers, each alone.
pub fn dampers(machine: &MachineFile, modes: &[Mode], response: &Response) -> Vec<Damped> {
    machine.dampers.iter().map(|ring| damped(ring, modes, response)).collect()
}

fn damped(ring: &DamperRing, modes: &[Mode], response: &Response) -> Damped {
    let main = Resonance::of(&modes[ring.mode], ring.mass);
    let damper = ring.sized(&main);
    let mass_ratio = damper.inertia / main.inertia;
    let square = ring.ratio * ring.ratio;
    let range = [0.5, 2.0].map(|part| part * main.frequency);
    let fixed = if ring.tuned { Resonance::tuned_amplitude } else { Resonance::viscous_amplitude };
    Damped {
        at: ring.at.clone(),
        kind: if ring.tuned { "tuned" } else { "viscous" },
        mode: ring.mode + 1,
        hz: main.frequency / TAU,
        mass_ratio,
        stiffness: damper.stiffness * square,
        damping: damper.damping * square,
        fixed_amplitude: fixed(mass_ratio),
        without: response.largest(ring.mass, range),
        with: response.with(ring.mass, &damper).largest(ring.mass, range),
    }
}

/// The table; none without dampers.
pub fn table(dampers: &[Damped]) -> Option<Section> {
    if dampers.is_empty() {
        return None;
    }
    let mut table = Table::new([
        "at",
        "damper",
        "mode",
        "Hz",
        "mass ratio",
        "stiffness N m/rad",
        "damping N m s/rad",
        "fixed points",
        "without rad/(N m)",
        "with rad/(N m)",
    ]);
    for damped in dampers {
        let sizes = [damped.hz, damped.mass_ratio, damped.stiffness, damped.damping, damped.fixed_amplitude];
        let largest = [damped.without, damped.with];
        let largest = largest.map(|angle| angle.map_or_else(|| "undamped".to_owned(), significant));
        table.row(
            [damped.at.clone(), damped.kind.to_owned(), damped.mode.to_string()]
                .into_iter()
                .chain(sizes.map(significant))
                .chain(largest),
        );
    }
    let text = "Each damper alone, its stiffness and damping on its own shaft; the best ones where the file has none. \
                Fixed points: amplitude over the static angle of one mass on one spring. Then the largest angle of the \
                mass per torque on it, from half to twice the frequency, of the whole machine at the motor.";
    Some(Section::new("Dampers", text, table))
}
