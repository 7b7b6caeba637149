//! Result of `modes` for a machine: vibrations, reductions, and sensitivity to each part.

use std::f64::consts::TAU;

use driveline::machine::{Element, Joint, Match};
use serde::Serialize;

use super::campbell::{Critical, barred, critical_speeds};
use super::damper::{Damped, dampers};
use super::engine::{FreeForces, excite, free};
use super::response::Response;
use crate::machine_file::MachineFile;

/// Change below which a part can be left out: 1 %, less than the accuracy of any stiffness.
pub const KEPT: f64 = 0.01;

/// The vibrations of a machine, everything referred to the motor.
#[derive(Clone, Debug, Serialize)]
pub struct Vibration {
    /// The machine's name.
    pub name: String,
    /// Its masses, from the motor.
    pub masses: Vec<Mass>,
    /// The shafts and ropes between them.
    pub shafts: Vec<Spring>,
    /// Natural vibrations of the free machine, lowest first.
    pub resonances: Vec<Resonance>,
    /// Natural frequencies with the motor locked (rad/s), lowest first.
    pub antiresonances: Vec<f64>,
    /// The two masses that can stand for it.
    pub reductions: Vec<Reduction>,
    /// Speeds of the motor at which an excitation meets a natural frequency, the lowest first.
    pub critical: Vec<Critical>,
    /// Ranges of the motor's speed that it must not dwell in (rad/s), rising and apart.
    pub barred: Vec<[f64; 2]>,
    /// Free forces and moments of the engine; `null` without one.
    pub engine: Option<FreeForces>,
    /// The dampers, each alone.
    pub dampers: Vec<Damped>,
    /// Changes without each part of a chain, the smallest first.
    pub sensitivity: Vec<Leaving>,
}

/// A mass.
#[derive(Clone, Debug, Serialize)]
pub struct Mass {
    /// Labels of what it is made of.
    pub name: String,
    /// Inertia (kg m2).
    pub inertia: f64,
    /// Viscous damping against the ground (N m s/rad).
    pub viscous: f64,
}

/// A shaft or rope.
#[derive(Clone, Debug, Serialize)]
pub struct Spring {
    /// Labels of what it is made of.
    pub name: String,
    /// Stiffness (N m/rad).
    pub stiffness: f64,
    /// Damping (N m s/rad).
    pub damping: f64,
    /// Whole free angle (rad).
    pub gap: f64,
}

/// A natural vibration.
#[derive(Clone, Debug, Serialize)]
pub struct Resonance {
    /// Frequency (rad/s).
    pub frequency: f64,
    /// Frequency (Hz).
    pub hz: f64,
    /// Damping ratio.
    pub damping_ratio: f64,
    /// Square of the mass-normalised shape at the motor (1/(kg m2)).
    pub residue: f64,
    /// Amplitude of each mass, the largest 1.
    pub shape: Vec<f64>,
}

/// Two masses that stand for the machine, and what they do not show of it.
#[derive(Clone, Debug, Serialize)]
pub struct Reduction {
    /// How they were found.
    pub by: String,
    /// Inertia on the motor's side (kg m2).
    pub motor_inertia: f64,
    /// Inertia on the load's side (kg m2).
    pub load_inertia: f64,
    /// Stiffness (N m/rad).
    pub stiffness: f64,
    /// Damping (N m s/rad).
    pub damping: f64,
    /// Relative error of the first resonance, signed.
    pub resonance_error: f64,
    /// Relative error of the first antiresonance, signed.
    pub antiresonance_error: f64,
    /// Relative error of the static compliance at the motor, signed.
    pub compliance_error: f64,
    /// Lowest frequency left out (rad/s); `null` where none is.
    pub next_mode: Option<f64>,
    /// Its share at the motor.
    pub next_share: f64,
    /// Bound of the error of the motor's speed after an impact, over its first step.
    pub worst: f64,
}

/// Changes without a part, relative and signed; `null` where no vibration would be left.
#[derive(Clone, Debug, Serialize)]
pub struct Leaving {
    /// The part.
    pub part: String,
    /// Change of the first resonance.
    pub resonance: Option<f64>,
    /// Change of the first antiresonance.
    pub antiresonance: Option<f64>,
    /// Change of the static compliance at the motor.
    pub compliance: Option<f64>,
    /// Whether to keep it: some change of [`KEPT`] or more.
    pub keep: bool,
}

impl Vibration {
    /// Of a machine.
    pub fn of(machine: &MachineFile) -> Self {
        let (masses, mut shafts) = machine.names();
        let joints = machine.joints();
        for (name, joint) in shafts.iter_mut().zip(&joints).filter(|(_, joint)| joint.from + 1 != joint.to) {
            *name = format!("{name}, from {}", masses[joint.from]);
        }
        let modes = machine.modes();
        let count = masses.len();
        let viscous = machine.viscous();
        // of the shafts, and against the ground
        let damping = |mode: &driveline::machine::Mode| {
            mode.damping + viscous.iter().zip(&mode.shape).map(|(viscous, share)| viscous * share * share).sum::<f64>()
        };
        let resonance = |mode: &driveline::machine::Mode| {
            let shape = &mode.shape[..count];
            let most =
                shape.iter().copied().fold(0.0, |most: f64, value| if value.abs() > most.abs() { value } else { most });
            Resonance {
                frequency: mode.frequency,
                hz: mode.frequency / TAU,
                damping_ratio: damping(mode) / (2.0 * mode.frequency),
                residue: mode.residue,
                shape: shape.iter().map(|value| value / most).collect(),
            }
        };
        let spring = |(name, joint): (&String, &Joint)| Spring {
            name: name.clone(),
            stiffness: joint.shaft.stiffness,
            damping: joint.shaft.damping,
            gap: joint.shaft.gap,
        };
        // parts are left out of chains only
        let mut sensitivity =
            if machine.train.is_none() { machine.chain.sensitivity().parts().to_vec() } else { Vec::new() };
        sensitivity.sort_by(|a, b| a.worst().total_cmp(&b.worst()));
        let finite = |value: f64| value.is_finite().then_some(value);
        let leaving = |part: &driveline::machine::Part| Leaving {
            part: match part.element {
                Element::Shaft(index) => format!("{} made rigid", shafts[index]),
                Element::Mass(index) => format!("inertia of {} left out", masses[index]),
            },
            resonance: finite(part.resonance),
            antiresonance: finite(part.antiresonance),
            compliance: finite(part.compliance),
            keep: part.worst() >= KEPT,
        };
        let frequencies: Vec<f64> = modes.resonances().iter().map(|mode| mode.frequency).collect();
        let mut critical = critical_speeds(&frequencies, machine.running.as_ref(), &machine.excitations);
        let response = Response::of(machine);
        if let Some(engine) = &machine.engine {
            let damping: Vec<f64> = modes.resonances().iter().map(damping).collect();
            excite(&mut critical, engine, modes.resonances(), &damping, &response);
        }
        let up_to = machine.running.as_ref().map_or(machine.limits.speed, |range| range.greatest);
        Self {
            name: machine.name.clone(),
            barred: barred(&critical, up_to),
            critical,
            engine: free(machine),
            dampers: dampers(machine, modes.resonances(), &response),
            resonances: modes.resonances().iter().map(resonance).collect(),
            antiresonances: modes.antiresonances().to_vec(),
            reductions: reductions(machine, &shafts),
            sensitivity: sensitivity.iter().map(leaving).collect(),
            shafts: shafts.iter().zip(&joints).map(spring).collect(),
            masses: masses
                .into_iter()
                .zip(machine.masses().iter().zip(&viscous))
                .map(|(name, (&inertia, &viscous))| Mass { name, inertia, viscous })
                .collect(),
        }
    }
}

/// Both matches, and the textbook's cut at every shaft. A machine of two masses or one has none to compare.
fn reductions(machine: &MachineFile, shafts: &[String]) -> Vec<Reduction> {
    let cut = |(index, name): (usize, &String)| {
        [
            (format!("cut at {name}, all shafts in series"), Match::TextbookCut(index)),
            (format!("cut at {name}, the others rigid"), Match::TextbookShaft(index)),
        ]
    };
    let matches = [
        ("same resonance and antiresonance".to_owned(), Match::ResonanceAntiresonance),
        ("first mode kept exactly".to_owned(), Match::ModalTruncation),
    ];
    let all = matches.into_iter().chain(shafts.iter().enumerate().flat_map(cut));
    let reduced = |(by, how): (String, Match)| {
        let two = machine.reduce(how).ok()?;
        Some(Reduction {
            by,
            motor_inertia: two.motor_inertia,
            load_inertia: two.load_inertia,
            stiffness: two.stiffness,
            damping: two.damping,
            resonance_error: two.error.resonance,
            antiresonance_error: two.error.antiresonance,
            compliance_error: two.error.compliance,
            next_mode: two.error.next_mode.is_finite().then_some(two.error.next_mode),
            next_share: two.error.next_share,
            worst: two.error.worst,
        })
    };
    all.filter_map(reduced).collect()
}
