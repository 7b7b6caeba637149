//! The page of `modes`: shapes, response at the motor, tables.

use std::f64::consts::TAU;

use driveline::machine::{Match, TwoMass};

use super::Vibration;
use super::campbell::diagram;
use super::figures::{campbell, shapes};
use super::tables::tables;
use crate::machine_file::MachineFile;
use driveline_report::chart::{Response, Station, response};
use driveline_report::format::significant;
use driveline_report::{Fact, Figure, Key, Sheet};

/// Points of a response.
const POINTS: usize = 1_600;

/// Least damping ratio that a response is drawn with: an undamped peak has no height.
const DRAWN_DAMPING: f64 = 1e-3;

/// A vibration as the motor sees it: frequency (rad/s), damping ratio, residue (1/(kg m2)).
type Seen = (f64, f64, f64);

/// The page as HTML.
pub fn page(machine: &MachineFile, vibration: &Vibration) -> String {
    let total: f64 = vibration.masses.iter().map(|mass| mass.inertia).sum();
    let station = |mass: &super::chain::Mass| Station { name: mass.name.clone(), share: mass.inertia / total };
    let fact = |name: &str, value: String| Fact { name: name.to_owned(), value };
    let mut facts = vec![
        fact("inertia at the motor", format!("{} kg m²", significant(total))),
        fact("masses", vibration.masses.len().to_string()),
    ];
    if let Some(mode) = vibration.resonances.first() {
        facts.push(fact("first resonance", format!("{} Hz", significant(mode.hz))));
        facts.push(fact("first antiresonance", format!("{} Hz", significant(vibration.antiresonances[0] / TAU))));
    }
    if machine.gravity_torque() != 0.0 {
        facts.push(fact("weight at the motor", format!("{} N m", significant(machine.gravity_torque()))));
    }
    let frequency = frequencies(vibration);
    let stations: Vec<Station> = vibration.masses.iter().map(station).collect();
    let responses = responses(machine, vibration, &frequency, total);
    let felt = (!responses.is_empty()).then(|| Figure {
        title: "What the motor feels".to_owned(),
        text: "Motor speed per motor torque: the whole chain, and the two masses that stand for it. Peaks are \
            resonances, \
               troughs antiresonances."
            .to_owned(),
        legend: responses.iter().map(|item| Key::curve(&*item.name, &*item.class)).collect(),
        plots: vec![response(&frequency, &responses)],
        ..Figure::default()
    });
    let natural: Vec<f64> = vibration.resonances.iter().map(|mode| mode.hz).collect();
    let diagram = diagram(&natural, machine.running.as_ref(), &machine.excitations, &vibration.critical);
    let modes = vibration.resonances.iter().map(|mode| (mode.hz, &*mode.shape));
    Sheet {
        name: machine.name.clone(),
        kicker: "natural vibrations and reduction".to_owned(),
        summary:
            "Natural vibrations, and the two masses that can stand for the machine in a controller. Everything is \
                  referred to the motor's shaft."
                .to_owned(),
        facts,
        figures: shapes(&stations, modes).into_iter().chain(felt).chain(diagram.map(campbell)).collect(),
        tables: tables(vibration),
    }
    .page()
}

/// Frequencies (Hz) from below the first antiresonance to above the last resonance, dense enough for the peaks.
fn frequencies(vibration: &Vibration) -> Vec<f64> {
    let (Some(&low), Some(high)) = (vibration.antiresonances.first(), vibration.resonances.last()) else {
        return Vec::new();
    };
    let (from, to) = ((low / TAU / 8.0).log10(), (high.hz * 3.0).log10());
    let even = (0..POINTS).map(|point| 10f64.powf(from + (to - from) * point as f64 / (POINTS - 1) as f64));
    let peaks = vibration.resonances.iter().map(|mode| mode.hz);
    let troughs = vibration.antiresonances.iter().map(|frequency| frequency / TAU);
    let mut all: Vec<f64> = even.chain(peaks).chain(troughs).collect();
    all.sort_by(f64::total_cmp);
    all
}

/// The whole chain, and the two matches.
fn responses(machine: &MachineFile, vibration: &Vibration, frequency: &[f64], total: f64) -> Vec<Response> {
    if vibration.resonances.is_empty() {
        return Vec::new();
    }
    let whole: Vec<Seen> =
        vibration.resonances.iter().map(|mode| (mode.frequency, mode.damping_ratio, mode.residue)).collect();
    let mut curves = vec![("whole chain".to_owned(), "truth".to_owned(), whole)];
    let matches = [
        ("same resonance and antiresonance", Match::ResonanceAntiresonance),
        ("first mode kept exactly", Match::ModalTruncation),
    ];
    // Two masses stand for themselves.
    for (index, (name, by)) in matches.into_iter().enumerate().filter(|_| vibration.masses.len() > 2) {
        if let Ok(two) = machine.reduce(by) {
            curves.push((name.to_owned(), format!("s{index}"), vec![seen(&two)]));
        }
    }
    let response = |(name, class, modes): (String, String, Vec<Seen>)| {
        let amplitude = frequency.iter().map(|hz| mobility(hz * TAU, total, &modes)).collect();
        Response { name, class, amplitude }
    };
    curves.into_iter().map(response).collect()
}

fn seen(two: &TwoMass) -> Seen {
    (two.resonance(), two.damping_ratio(), two.load_inertia / (two.motor_inertia * two.total_inertia()))
}

/// Size of the motor's speed per torque: `|1/(J s) + sum r s/(s^2 + 2 z w s + w^2)|` at `s = j omega`.
fn mobility(omega: f64, total: f64, modes: &[Seen]) -> f64 {
    let (mut re, mut im) = (0.0, -1.0 / (total * omega));
    for &(w, damping, residue) in modes {
        let (a, b) = (w * w - omega * omega, 2.0 * damping.max(DRAWN_DAMPING) * w * omega);
        let square = a * a + b * b;
        re += residue * omega * b / square;
        im += residue * omega * a / square;
    }
    f64::hypot(re, im)
}
