//! Amplitudes of one plane without phases.

use driveline::balancing::{Entry, Error, from_amplitudes};

use super::file::{BalanceFile, Measured};
use crate::machine_file::{Diagnostic, Item, Quantity, Table};

/// Keys of the file that go with readings with phases.
const OF_PHASES: [&str; 13] = [
    "baseline",
    "sensors",
    "trial",
    "machine",
    "influence",
    "correction",
    "trials",
    "aim",
    "good",
    "independence",
    "weighting",
    "limits",
    "run_out",
];

/// Reads `[amplitudes]`.
pub(super) fn amplitudes(root: &mut Table<'_>, file: &BalanceFile) -> Result<Measured, Diagnostic> {
    if file.planes.len() > 1 {
        return Err(root.wrong("planes", "one plane: amplitudes without phases cannot separate two"));
    }
    if !file.splits.is_empty() {
        return Err(root.wrong("split", "no [[split]] beside [amplitudes]: [[holes]] at the two angles"));
    }
    if let Some(key) = OF_PHASES.iter().find(|key| root.has(key)) {
        let expected = "only beside [baseline], whose readings have phases, not beside [amplitudes]";
        return Err(root.wrong(key, expected));
    }
    let mut table = root.table("amplitudes")?;
    let expected = "a list of two numbers, [angle in degrees, amplitude]";
    let runs = table.items("runs", expected)?;
    let run = |item: &Item<'_>| item.pair(Quantity::DEGREES, Quantity::AMPLITUDE, expected);
    let runs: Vec<(f64, f64)> = runs.iter().map(run).collect::<Result<_, _>>()?;
    let baseline = table.number("baseline", Quantity::AMPLITUDE)?;
    let weight = table.number("weight", Quantity::WEIGHT)?;
    let mut angles = Entry::new();
    for (degrees, _) in &runs {
        angles.polar(1.0, *degrees);
    }
    let radians: Vec<(f64, f64)> =
        runs.iter().map(|(angle, amplitude)| (file.angles.degrees(*angle).to_radians(), *amplitude)).collect();
    let found = file.angles.check(&angles).and_then(|()| from_amplitudes(baseline, weight, &radians));
    let found = found.map_err(|refusal| match refusal {
        Error::TrialWeightZero { .. } => table.wrong("weight", format!("a weight above zero ({refusal})")),
        Error::Reading { row: 0 } => table.wrong("baseline", "an amplitude above zero"),
        Error::PhasesInRadians => table.wrong("runs", format!("angles in degrees: {refusal}")),
        Error::ReadingMissing { .. } => table.wrong("runs", "three runs at different angles, or two"),
        Error::NoEffect { .. } => table.wrong("runs", format!("other amplitudes than the baseline's ({refusal})")),
        _ => table.wrong(
            "runs",
            "runs at different angles, not on one line through the shaft, with amplitudes consistent with one \
             influence; repeat them, or take a larger trial weight",
        ),
    })?;
    table.finish()?;
    Ok(Measured::Amplitudes { baseline, found })
}
