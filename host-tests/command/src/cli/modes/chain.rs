//! Result of `modes` for a machine: vibrations, reductions, and sensitivity to each part.

use std::f64::consts::TAU;

use driveline::machine::{Element, Joint, Match};
use serde::Serialize;

use super::campbell::{Critical, barred, critical_speeds};
use super::damped::DampedVibration;
use super::damper::{Damped, dampers};
use super::engine::{FreeForces, excite, free};
use super::response::Response;
use super::starts::{Starts, starts};
use crate::cli::Failure;
use crate::machine_file::MachineFile;

/// Change below which a part can be left out: 1 %, less than the accuracy of any stiffness.
pub const KEPT: f64 = 0.01;

/// Least number of modes of a machine whose shafts have an inertia of their own.
pub const LEAST: usize = 10;

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
    /// Damped vibrations and decays, the slowest first; none of a machine without damping.
    pub damped: Vec<DampedVibration>,
    /// The two masses that can stand for it.
    pub reductions: Vec<Reduction>,
    /// Dynamic factors of starts; `null` without a shaft.
    pub starts: Option<Starts>,
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
    /// The mode that they stand for, from 1.
    pub mode: usize,
    /// Inertia on the motor's side (kg m2).
    pub motor_inertia: f64,
    /// Inertia on the load's side (kg m2).
    pub load_inertia: f64,
    /// Stiffness (N m/rad).
    pub stiffness: f64,
    /// Damping (N m s/rad).
    pub damping: f64,
    /// Relative error of that mode's resonance, signed.
    pub resonance_error: f64,
    /// Relative error of its antiresonance, signed.
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
    pub fn of(machine: &MachineFile) -> Result<Self, Failure> {
        let (masses, mut shafts) = machine.names();
        let joints = machine.joints();
        for (name, joint) in shafts.iter_mut().zip(&joints).filter(|(_, joint)| joint.from + 1 != joint.to) {
            *name = format!("{name}, from {}", masses[joint.from]);
        }
        let count = masses.len();
        let viscous = machine.viscous();
        let response = Response::of(machine);
        let network = response.network();
        // shafts with an inertia of their own have modes without end
        let most = if network.is_distributed() { LEAST.max(count - 1) } else { count - 1 };
        let mut modes = network.modes(most);
        let decays = network.decays(&modes).map_err(|error| Failure::failed(error.to_string()))?;
        modes.shapes.iter_mut().for_each(|shape| shape.truncate(count));
        let resonance = |(&frequency, shape): (&f64, &Vec<f64>)| {
            let most =
                shape.iter().copied().fold(0.0, |most: f64, value| if value.abs() > most.abs() { value } else { most });
            Resonance {
                frequency,
                hz: frequency / TAU,
                residue: shape[0] * shape[0],
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
        let is_chain = machine.train.is_none() && machine.chain.error().is_none();
        let mut sensitivity = if is_chain { machine.chain.sensitivity().parts().to_vec() } else { Vec::new() };
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
        let mut critical = critical_speeds(&modes.omega, machine.running.as_ref(), &machine.excitations);
        if let Some(engine) = &machine.engine {
            excite(&mut critical, engine, &modes, &response);
        }
        let antiresonances = network.held(0).modes(most).omega;
        let up_to = machine.running.as_ref().map_or(machine.limits.speed, |range| range.greatest);
        Ok(Self {
            name: machine.name.clone(),
            barred: barred(&critical, up_to),
            critical,
            engine: free(machine),
            dampers: dampers(machine, &modes, &response),
            resonances: modes.omega.iter().zip(&modes.shapes).map(resonance).collect(),
            damped: DampedVibration::all(&decays),
            starts: starts(machine),
            reductions: reductions(machine, &shafts, &modes.omega, &antiresonances),
            antiresonances,
            sensitivity: sensitivity.iter().map(leaving).collect(),
            shafts: shafts.iter().zip(&joints).map(spring).collect(),
            masses: masses
                .into_iter()
                .zip(machine.masses().iter().zip(&viscous))
                .map(|(name, (&inertia, &viscous))| Mass { name, inertia, viscous })
                .collect(),
        })
    }
}

/// Both matches, and the textbook's cut at every shaft. A machine without a shaft has none, nor has one
/// of more masses than the library's chain holds. The mode that each stands for is named.
fn reductions(machine: &MachineFile, shafts: &[String], omega: &[f64], held: &[f64]) -> Vec<Reduction> {
    if machine.long.is_some() {
        return Vec::new();
    }
    let cut = |(index, name): (usize, &String)| {
        [
            (format!("cut at {name}, all shafts in series"), Match::TextbookCut(index)),
            (format!("cut at {name}, the others rigid"), Match::TextbookShaft(index)),
        ]
    };
    let matches = [
        ("same resonance and antiresonance".to_owned(), Match::ResonanceAntiresonance),
        ("one mode kept exactly".to_owned(), Match::ModalTruncation),
    ];
    let all = matches.into_iter().chain(shafts.iter().enumerate().flat_map(cut));
    let lumped = machine.modes();
    let reduced = |(by, how): (String, Match)| {
        let two = machine.reduce(how).ok()?;
        // of masses and springs alone, as the library has the machine
        let main = two.resonance() / (1.0 + two.error.resonance);
        let mode = nearest(lumped.resonances().iter().map(|mode| mode.frequency), main);
        let below = two.antiresonance() / (1.0 + two.error.antiresonance);
        let trough = nearest(lumped.antiresonances().iter().copied(), below);
        Some(Reduction {
            by: by.replacen("one mode kept", &format!("mode {} kept", mode + 1), 1),
            mode: mode + 1,
            motor_inertia: two.motor_inertia,
            load_inertia: two.load_inertia,
            stiffness: two.stiffness,
            damping: two.damping,
            resonance_error: (two.error.resonance + 1.0) * (main / omega[mode]) - 1.0,
            antiresonance_error: (two.error.antiresonance + 1.0) * (below / held[trough]) - 1.0,
            compliance_error: two.error.compliance,
            next_mode: two.error.next_mode.is_finite().then_some(two.error.next_mode),
            next_share: two.error.next_share,
            worst: two.error.worst,
        })
    };
    all.filter_map(reduced).collect()
}

/// Index of the frequency that is nearest to one.
fn nearest(all: impl Iterator<Item = f64>, to: f64) -> usize {
    let off = |frequency: f64| (frequency / to - 1.0).abs();
    all.enumerate().min_by(|(_, a), (_, b)| off(*a).total_cmp(&off(*b))).map_or(0, |(index, _)| index)
}
