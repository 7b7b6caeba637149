//! Dynamic factors of the starts of a machine, of its two masses with the first mode, undamped.

use std::f64::consts::TAU;

use driveline::machine::{Match, StartingLaw, Torque, TwoMass};
use driveline_report::format::significant;
use driveline_report::{Section, Table};
use serde::Serialize;

use crate::machine_file::MachineFile;

/// Durations of a start, in periods of the vibration.
const PERIODS: [f64; 6] = [0.25, 0.5, 1.0, 1.5, 2.5, 5.0];

/// Allowed factors that have a slew.
const ALLOWED: [f64; 3] = [1.1, 1.2, 1.5];

/// Largest torque of the shaft over that of a slow change, for each way to start.
#[derive(Clone, Debug, Serialize)]
pub struct Starts {
    /// Frequency of the vibration (rad/s).
    pub resonance: f64,
    /// Factors against the duration.
    pub factors: Vec<Factors>,
    /// Torque per time (N m/s) of a change by the torque limit, for an allowed factor.
    pub slew: Vec<[f64; 2]>,
    /// Torque that the shaft turns to (N m) where the motor reverses from its limit to the other one at once.
    pub reversal: f64,
}

/// Factors of starts of one duration.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Factors {
    /// Duration (s).
    pub time: f64,
    /// Torque that rises evenly and stays.
    pub ramp: f64,
    /// Constant torque that ends.
    pub pulse: f64,
    /// `1 - t/T`, of the torque at the start.
    pub soft: f64,
    /// `1 - t^2/T^2`.
    pub medium: f64,
}

/// Of a machine that two masses can stand for.
pub fn starts(machine: &MachineFile) -> Option<Starts> {
    let two = machine.reduce(Match::ResonanceAntiresonance).ok().filter(|_| machine.long.is_none())?;
    let (period, limit) = (TAU / two.resonance(), machine.limits.torque);
    let at = |periods: f64| {
        let time = periods * period;
        Factors {
            time,
            ramp: two.ramp_factor(time),
            pulse: two.pulse_factor(time),
            soft: two.law_factor(&StartingLaw::Soft { torque: limit, time }),
            medium: two.law_factor(&StartingLaw::Medium { torque: limit, time }),
        }
    };
    Some(Starts {
        resonance: two.resonance(),
        factors: PERIODS.map(at).to_vec(),
        slew: ALLOWED.map(|factor| [factor, two.slew_for_factor(Torque(limit), factor)]).to_vec(),
        reversal: reversal(&two, limit),
    })
}

fn reversal(two: &TwoMass, limit: f64) -> f64 {
    let before = two.accelerating_torque(Torque(limit), Torque(0.0));
    two.reversal_torque(before, Torque(-limit), Torque(0.0)).0
}

/// The table of the factors.
pub fn table(starts: &Starts) -> Section {
    let headings = ["start within s", "even rise", "pulse", "soft, 1 - t/T", "medium, 1 - t²/T²"];
    let mut table = Table::new(headings);
    for row in &starts.factors {
        table.row([row.time, row.ramp, row.pulse, row.soft, row.medium].map(significant));
    }
    let slew: Vec<_> =
        starts.slew.iter().map(|&[factor, slew]| format!("{} for {factor}", significant(slew))).collect();
    let text = format!(
        "Largest shaft torque over that of a slow change, of two masses at {} Hz without damping; a step has 2. Slew of \
         a change by the torque limit, N m/s for an allowed factor: {}. A reversal at the torque limit turns the shaft \
         to {} N m.",
        significant(starts.resonance / TAU),
        slew.join(", "),
        significant(starts.reversal)
    );
    Section::new("Dynamic factors of starts", text, table)
}
