//! Dampers: their best size, and the machine's response with and without them.

use std::f64::consts::TAU;

use driveline::machine::{Damper, Mode, Resonance};
use nalgebra::Complex;
use serde::Serialize;

use crate::machine_file::{DamperRing, MachineFile};
use driveline_report::format::significant;
use driveline_report::{Section, Table};

/// Points of a response between half and twice the mode's frequency.
const POINTS: usize = 8_000;

/// A damper and what it does, alone.
#[derive(Clone, Debug, Serialize)]
pub struct Damped {
    /// Label of its mass.
    pub at: String,
    /// `tuned` or `viscous`.
    pub kind: &'static str,
    /// Mode that it damps, from 1.
    pub mode: usize,
    /// Frequency of that mode \[Hz\].
    pub hz: f64,
    /// Inertia of the ring over that of the mode at the mass.
    pub mass_ratio: f64,
    /// Stiffness on its own shaft \[N m/rad\]; 0 of a viscous one.
    pub stiffness: f64,
    /// Damping on its own shaft \[N m s/rad\].
    pub damping: f64,
    /// Amplitude over the static angle in the fixed points, of one mass with the best damper.
    pub fixed_amplitude: f64,
    /// Largest angle of the mass per torque on it, from half to twice the frequency, both at the motor
    /// \[rad/(N m)\]; `null` for an undamped machine.
    pub without: Option<f64>,
    /// The same with the damper.
    pub with: f64,
}

/// The machine's dampers, each alone.
pub fn dampers(machine: &MachineFile, modes: &[Mode]) -> Vec<Damped> {
    let total: f64 = machine.masses().iter().sum();
    machine.dampers.iter().map(|ring| damped(ring, modes, total)).collect()
}

fn damped(ring: &DamperRing, modes: &[Mode], total: f64) -> Damped {
    let main = Resonance::of(&modes[ring.mode], ring.mass);
    let damper = ring.sized(&main);
    let mass_ratio = damper.inertia / main.inertia;
    let square = ring.ratio * ring.ratio;
    let even = |point: usize| main.frequency * 4f64.powf(point as f64 / (POINTS - 1) as f64 - 0.5);
    let angle =
        |omega: f64, damper: Option<&Damper>| with(receptance(omega, ring.mass, modes, total), damper, omega).norm();
    let largest = |damper: Option<&Damper>| (0..POINTS).map(|point| angle(even(point), damper)).fold(0.0, f64::max);
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
        // the resonance itself lies between two points
        without: (modes[ring.mode].damping > 0.0).then(|| largest(None).max(angle(main.frequency, None))),
        with: largest(Some(&damper)),
    }
}

/// Angle of a mass per torque on it: `sum psi^2/(omega_i^2 - omega^2 + i D omega) - 1/(J omega^2)`.
fn receptance(omega: f64, mass: usize, modes: &[Mode], total: f64) -> Complex<f64> {
    let of = |mode: &Mode| {
        let psi = mode.shape[mass];
        psi * psi / Complex::new(mode.frequency * mode.frequency - omega * omega, mode.damping * omega)
    };
    modes.iter().map(of).sum::<Complex<f64>>() - 1.0 / (total * omega * omega)
}

/// The receptance with a damper on the same mass.
fn with(receptance: Complex<f64>, damper: Option<&Damper>, omega: f64) -> Complex<f64> {
    let Some(damper) = damper else { return receptance };
    let [real, imaginary] = damper.dynamic_stiffness(omega);
    receptance / (receptance * Complex::new(real, imaginary) + 1.0)
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
        let without = damped.without.map_or_else(|| "undamped".to_owned(), significant);
        table.row(
            [damped.at.clone(), damped.kind.to_owned(), damped.mode.to_string()]
                .into_iter()
                .chain(sizes.map(significant))
                .chain([without, significant(damped.with)]),
        );
    }
    let text = "Each damper alone, its stiffness and damping on its own shaft; the best ones where the file has none. \
                Fixed points: amplitude over the static angle of one mass on one spring. Then the largest angle of the \
                mass per torque on it, from half to twice the frequency, of the whole machine at the motor.";
    Some(Section::new("Dampers", text, table))
}
