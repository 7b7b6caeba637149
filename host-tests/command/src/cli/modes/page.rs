//! The page of `modes`: shapes, response at the motor, tables.

use std::f64::consts::TAU;

use driveline::machine::{Match, TwoMass};
use nalgebra::Complex;

use super::Vibration;
use super::campbell::diagram;
use super::figures::{campbell, shapes};
use super::response::Response as Forced;
use super::tables::tables;
use crate::machine_file::MachineFile;
use driveline_report::chart::{Curve, Lines, Station};
use driveline_report::format::significant;
use driveline_report::{Figure, Key, Sheet, fact};

/// Points of a response.
const POINTS: usize = 1_600;

/// Least damping ratio that a response is drawn with: an undamped peak has no height.
const DRAWN_DAMPING: f64 = 1e-3;

/// The page as HTML.
pub fn page(machine: &MachineFile, vibration: &Vibration) -> String {
    let total: f64 = vibration.masses.iter().map(|mass| mass.inertia).sum();
    let station = |mass: &super::chain::Mass| Station { name: mass.name.clone(), share: mass.inertia / total };
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
    let (legend, curves) = responses(machine, vibration, &frequency);
    let felt = (!curves.is_empty()).then(|| {
        let text = "Motor speed per motor torque: the whole chain, and the two masses that stand for it. Peaks are \
                    resonances, troughs antiresonances.";
        let lines = Lines {
            label: "Motor speed per motor torque over frequency".to_owned(),
            along: "frequency, Hz".to_owned(),
            across: "motor speed per torque, rad/s per N m".to_owned(),
            places: frequency.clone(),
            curves,
            logarithmic: true,
            decades: true,
            ..Lines::default()
        };
        Figure::new("What the motor feels", text, legend, vec![lines.draw()])
    });
    let natural: Vec<f64> = vibration.resonances.iter().map(|mode| mode.hz).collect();
    let diagram = diagram(&natural, machine.running.as_ref(), &machine.excitations, &vibration.critical);
    let modes = vibration.resonances.iter().map(|mode| (mode.hz, &*mode.shape));
    let links: Vec<[usize; 2]> = machine.joints().iter().map(|joint| [joint.from, joint.to]).collect();
    Sheet {
        name: machine.name.clone(),
        kicker: "natural vibrations and reduction".to_owned(),
        summary:
            "Natural vibrations, and the two masses that can stand for the machine in a controller. Everything is \
                  referred to the motor's shaft."
                .to_owned(),
        facts,
        figures: shapes(&stations, &links, modes).into_iter().chain(felt).chain(diagram.map(campbell)).collect(),
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
    // the peaks of many modes lie as near to each other as the points
    let near = |count: usize| count.min(POINTS / 4);
    let even = (0..POINTS).map(|point| 10f64.powf(from + (to - from) * point as f64 / (POINTS - 1) as f64));
    let peaks = vibration.resonances.iter().take(near(vibration.resonances.len())).map(|mode| mode.hz);
    let troughs =
        vibration.antiresonances.iter().take(near(vibration.antiresonances.len())).map(|frequency| frequency / TAU);
    let mut all: Vec<f64> = even.chain(peaks).chain(troughs).collect();
    all.sort_by(f64::total_cmp);
    all
}

/// The whole chain, and the two matches.
fn responses(machine: &MachineFile, vibration: &Vibration, frequency: &[f64]) -> (Vec<Key>, Vec<Curve>) {
    if vibration.resonances.is_empty() {
        return Default::default();
    }
    let least = vibration.damped.iter().map(|one| one.damping_ratio).fold(f64::INFINITY, f64::min);
    let drawn = if least > DRAWN_DAMPING && least.is_finite() { 0.0 } else { DRAWN_DAMPING };
    let shift = |hz: &f64| Complex::new(drawn, 1.0) * (hz * TAU);
    let shifts: Vec<Complex<f64>> = frequency.iter().map(shift).collect();
    let whole = Forced::of(machine).receptances(0, &shifts);
    let amplitude = whole.iter().zip(&shifts).map(|(angle, shift)| angle * shift.norm()).collect();
    let mut keys = vec![Key::curve("whole chain", "truth")];
    let mut curves = vec![Curve { class: "truth".to_owned(), values: amplitude }];
    // Two masses stand for themselves.
    let matches = vibration.reductions.iter().zip([Match::ResonanceAntiresonance, Match::ModalTruncation]);
    for (index, (reduction, by)) in matches.enumerate().filter(|_| vibration.masses.len() > 2) {
        if let Ok(two) = machine.reduce(by) {
            let (class, values) = (format!("s{index}"), shifts.iter().map(|shift| mobility(*shift, &two)).collect());
            keys.push(Key::curve(&*reduction.by, &*class));
            curves.push(Curve { class, values });
        }
    }
    (keys, curves)
}

/// Size of the motor's speed per torque of two masses at a shift `s`: `(J s^2 + d s + k)` of the load over the
/// characteristic polynomial.
fn mobility(shift: Complex<f64>, two: &TwoMass) -> f64 {
    let coupling = shift * two.damping + two.stiffness;
    let [motor, load] = [two.motor_inertia, two.load_inertia].map(|inertia| shift * shift * inertia);
    (shift * (load + coupling) / (motor * load + coupling * (motor + load))).norm()
}
