//! Dampers: their best size, and the machine's response with and without them.

use std::f64::consts::TAU;

use driveline::machine::Resonance;
use driveline_solver::plant::vibration::Modes;
use serde::Serialize;

use super::response::Response;
use crate::machine_file::{DamperKind, DamperRing, MachineFile};
use driveline_report::format::significant;
use driveline_report::{Section, Table};

/// A damper and what it does, alone.
#[derive(Clone, Debug, Serialize)]
pub struct Damped {
    /// Label of its mass.
    pub at: String,
    /// `tuned`, `viscous`, `friction`, `absorber` or `pendulum`.
    pub kind: &'static str,
    /// Mode that it damps, from 1; `null` of what is tuned to an excitation, as the next.
    pub mode: Option<usize>,
    /// Inertia of the ring over that of the mode at the mass.
    pub mass_ratio: Option<f64>,
    /// Frequency of that mode, or of the excitation (Hz).
    pub hz: f64,
    /// Stiffness on its own shaft (N m/rad); of a pendulum at its speed.
    pub stiffness: f64,
    /// Damping on its own shaft (N m s/rad).
    pub damping: f64,
    /// Friction torque on its own shaft (N m); `null` without friction.
    pub friction: Option<f64>,
    /// Length of a pendulum (m); `null` without one, as the next.
    pub length: Option<f64>,
    /// Swing of a pendulum per torque of its order (rad/(N m)) at its speed.
    pub swing: Option<f64>,
    /// Amplitude over the static angle of one mass with the best damper: in the fixed points, of a friction damper at
    /// the natural frequency; `null` of an absorber.
    pub fixed_amplitude: Option<f64>,
    /// Largest angle of the mass per torque on it, from half to twice the frequency, or at the frequency of an
    /// absorber, both at the motor (rad/(N m)); `null` where no damping limits it.
    pub without: Option<f64>,
    /// The same with the damper; of a friction damper that of one mass under the torque of its file.
    pub with: Option<f64>,
}

/// The machine's dampers, each alone.
pub fn dampers(machine: &MachineFile, modes: &Modes, response: &Response) -> Vec<Damped> {
    machine.dampers.iter().map(|ring| damped(ring, modes, response)).collect()
}

fn damped(ring: &DamperRing, modes: &Modes, response: &Response) -> Damped {
    let main = ring
        .kind
        .mode()
        .map(|mode| Resonance { inertia: modes.shapes[mode][ring.mass].powi(-2), frequency: modes.omega[mode] });
    let damper = ring.sized(main.as_ref());
    let mass_ratio = main.map(|main| damper.inertia / main.inertia);
    let square = ring.ratio * ring.ratio;
    let fixed: fn(f64) -> f64 = match ring.kind {
        DamperKind::Tuned { .. } => Resonance::tuned_amplitude,
        DamperKind::Viscous { .. } => Resonance::viscous_amplitude,
        _ => Resonance::friction_amplitude,
    };
    let fixed_amplitude = mass_ratio.map(fixed);
    let friction = main.as_ref().and_then(|main| ring.friction(main));
    let pendulum = match ring.kind {
        DamperKind::Pendulum { pendulum, speed, .. } => Some((pendulum.length, pendulum.swing(1.0, speed))),
        _ => None,
    };
    let with = response.with(ring.mass, &damper);
    let at = |response: &Response| match (ring.kind.absorbs(), main) {
        (Some(omega), _) => Some(response.receptance(ring.mass, omega)).filter(|angle| angle.is_finite()),
        (None, Some(main)) => response.largest(ring.mass, [0.5, 2.0].map(|part| part * main.frequency)),
        (None, None) => None,
    };
    let omega = ring.kind.absorbs().or(main.map(|main| main.frequency)).unwrap_or(0.0);
    Damped {
        at: ring.at.clone(),
        kind: ring.kind.name(),
        mode: ring.kind.mode().map(|mode| mode + 1),
        hz: omega / TAU,
        mass_ratio,
        stiffness: damper.stiffness * square,
        damping: damper.damping * square,
        friction: friction.map(|friction| friction.torque * ring.ratio),
        length: pendulum.map(|(length, _)| length),
        swing: pendulum.map(|(_, swing)| swing),
        fixed_amplitude,
        without: at(response),
        with: match (friction, main, fixed_amplitude) {
            (Some(_), Some(main), Some(amplitude)) => Some(amplitude / main.stiffness()),
            _ => at(&with),
        },
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
        "friction N m",
        "length m",
        "swing rad/(N m)",
        "fixed points",
        "without rad/(N m)",
        "with rad/(N m)",
    ]);
    let shown = |value: Option<f64>| value.map_or_else(String::new, significant);
    for damped in dampers {
        let mode = damped.mode.map_or_else(String::new, |mode| mode.to_string());
        let sizes = [Some(damped.hz), damped.mass_ratio, Some(damped.stiffness), Some(damped.damping)];
        let others = [damped.friction, damped.length, damped.swing, damped.fixed_amplitude];
        let largest = [damped.without, damped.with];
        let largest = largest.map(|angle| angle.map_or_else(|| "undamped".to_owned(), significant));
        table.row(
            [damped.at.clone(), damped.kind.to_owned(), mode]
                .into_iter()
                .chain(sizes.into_iter().chain(others).map(shown))
                .chain(largest),
        );
    }
    let text = "Each damper alone, its stiffness and damping on its own shaft; the best ones where the file has none. \
                Fixed points: amplitude over the static angle of one mass on one spring. Then the largest angle of the \
                mass per torque on it, from half to twice the frequency, of the whole machine at the motor; of an \
                absorber at its frequency, with a friction damper of one mass under the torque of the file.";
    Some(Section::new("Dampers", text, table))
}
