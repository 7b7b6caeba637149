//! The tables of a chain's natural vibrations: for the terminal and the page alike.

use std::f64::consts::TAU;

use driveline_report::format::{DIVERGED, percent, significant};
use driveline_report::{Section, Table};

use super::campbell::{barred_speeds, critical};
use super::chain::{KEPT, Leaving, Reduction, Vibration};
use super::{damped, damper, engine, starts};

/// Most masses or coordinates whose amplitudes have a column.
pub const SHOWN: usize = 24;

/// The tables as title, explanation and table: for the terminal and the page alike.
pub fn tables(vibration: &Vibration) -> Vec<Section> {
    let mut all = Vec::new();
    let is_viscous = vibration.masses.iter().any(|mass| mass.viscous > 0.0);
    let headings = ["part", "inertia kg m²", "stiffness N m/rad", "damping N m s/rad", "gap rad"];
    let mut parts = Table::new(headings.into_iter().chain(is_viscous.then_some("viscous N m s/rad")));
    for (index, mass) in vibration.masses.iter().enumerate() {
        let row = [mass.name.clone(), significant(mass.inertia)];
        if is_viscous {
            parts.row(row.into_iter().chain([String::new(), String::new(), String::new(), significant(mass.viscous)]));
        } else {
            parts.row(row);
        }
        if let Some(shaft) = vibration.shafts.get(index) {
            let numbers = [shaft.stiffness, shaft.damping, shaft.gap].map(significant);
            parts.row([shaft.name.clone(), String::new()].into_iter().chain(numbers));
        }
    }
    all.push(Section::new("Machine, referred to the motor", "", parts));
    if vibration.resonances.is_empty() {
        return all;
    }
    // a line for each mode is read, a column for each of many masses is not
    let shown = if vibration.masses.len() <= SHOWN { &*vibration.masses } else { &[] };
    let mut modes = Table::new(
        ["mode", "Hz", "rad/s", "antiresonance Hz"]
            .map(String::from)
            .into_iter()
            .chain(shown.iter().map(|mass| mass.name.clone())),
    );
    for (index, mode) in vibration.resonances.iter().enumerate() {
        let held = vibration.antiresonances.get(index).copied().unwrap_or(f64::NAN);
        let numbers = [mode.hz, mode.frequency, held / TAU].map(significant);
        let shape = mode.shape.iter().take(shown.len()).map(|value| format!("{value:+.3}"));
        modes.row([(index + 1).to_string()].into_iter().chain(numbers).chain(shape));
    }
    let shapes = match shown {
        [] => "shapes of more than 24 masses with `--json`.",
        _ => "amplitudes of the masses, the largest 1.",
    };
    let text = format!("Frequencies of the free machine, and with the motor locked; {shapes}");
    all.push(Section::new("Frequencies and shapes", text, modes));
    all.extend(damped::table(&vibration.damped, "With all dampings, gaps closed."));
    all.extend(critical(&vibration.critical));
    all.extend(barred_speeds(&vibration.barred));
    all.extend(vibration.engine.as_ref().map(engine::table));
    all.extend(damper::table(&vibration.dampers));
    all.extend(reductions(&vibration.reductions));
    all.extend(vibration.starts.as_ref().map(starts::table));
    if !vibration.sensitivity.is_empty() {
        all.push(sensitivity(&vibration.sensitivity));
    }
    all
}

fn reductions(reductions: &[Reduction]) -> Option<Section> {
    let mut table = Table::new([
        "two masses by",
        "mode",
        "motor kg m²",
        "load kg m²",
        "stiffness N m/rad",
        "damping N m s/rad",
        "resonance",
        "antiresonance",
        "compliance",
        "next mode Hz",
        "its share",
        "worst",
    ]);
    for r in reductions {
        let sizes = [r.motor_inertia, r.load_inertia, r.stiffness, r.damping].map(significant);
        let errors = [r.resonance_error, r.antiresonance_error, r.compliance_error].map(signed);
        let next = r.next_mode.map_or_else(|| "none".to_owned(), |next| significant(next / TAU));
        let rest = [next, significant(r.next_share), percent(r.worst)];
        table.row([r.by.clone(), r.mode.to_string()].into_iter().chain(sizes).chain(errors).chain(rest));
    }
    let text = "The mode that each stands for, with the errors of its resonance, of its antiresonance and of the \
                static compliance at the motor; the lowest mode left out and its share at the motor (1 equals the \
                rigid-body mode); a bound of the error of the motor's speed after an impact, over its first step.";
    (!reductions.is_empty()).then(|| Section::new("Reduction to two masses", text, table))
}

fn sensitivity(parts: &[Leaving]) -> Section {
    let mut table = Table::new(["simplification", "resonance", "antiresonance", "compliance", "keep"]);
    let change = |value: Option<f64>| value.map_or_else(|| "none left".to_owned(), signed);
    for part in parts {
        let changes = [part.resonance, part.antiresonance, part.compliance].map(change);
        let verdict = if part.keep { "yes" } else { "no" };
        table.row([part.part.clone()].into_iter().chain(changes).chain([verdict.to_owned()]));
    }
    let text = format!(
        "Computed change at the motor when a part is left out; below {} in all three it can be left out.",
        percent(KEPT)
    );
    Section::new("Sensitivity to each part", text, table)
}

/// A relative change in percent with its sign; what rounding leaves is none.
fn signed(change: f64) -> String {
    match percent(change) {
        text if text == DIVERGED => text,
        _ if change.abs() < 1e-9 => "0 %".to_owned(),
        text if change > 0.0 => format!("+{text}"),
        text => text,
    }
}
