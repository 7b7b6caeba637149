//! Runs with phases, given to the procedure one by one.

use driveline::balancing::{Aim, CORRECTIONS, Complex, Entry, Error, Influence, Objective, Plan};

use super::file::{BalanceFile, Field, Measured, PLANES, ROWS, TRIALS};
use super::hard_bearing::hard_bearing;
use super::polar::{pairs, weight};
use super::run::{Common, refused, run};
use super::units::AngleConvention;
use super::value::{ABOVE_ZERO, choice, list, plane};
use crate::machine_file::{Diagnostic, Item, Quantity, Table};

/// The runs, given to the procedure one by one.
pub(super) fn phasors(root: &mut Table<'_>, file: &BalanceFile) -> Result<Measured, Diagnostic> {
    let (planes, rows, convention) = (file.planes.as_slice(), file.sensors.len(), file.angles);
    let mut aim = Aim::<f64, ROWS, PLANES> {
        objective: choice(root, "aim", &[("least squares", Objective::LeastSquares), ("min-max", Objective::MinMax)])?,
        independence: root.number_or("independence", Quantity::SHARE, 0.01)?,
        ..Aim::default()
    };
    let leave_trials = choice(root, "trials", &[("removed", false), ("stay", true)])?;
    let good = root.number_or("good", Quantity::AMPLITUDE, f64::MIN_POSITIVE)?;
    for (value, weighting) in list(root, "weighting", rows, Quantity::WEIGHT)?.into_iter().zip(&mut aim.weighting) {
        *weighting = value;
    }
    let readings = aim.weighting.iter().take(rows).filter(|weighting| **weighting > 0.0).count();
    if readings < planes.len() && readings < rows {
        let refusal = Error::MorePlanesThanReadings { planes: planes.len(), readings };
        return Err(root.wrong("weighting", format!("a reading above zero for each plane: {refusal}")));
    }
    for (value, limit) in limits(root, planes.len())?.into_iter().zip(&mut aim.limits) {
        *limit = value;
    }
    let plan = Plan { leave_trials, aim, ..Plan::usual(rows, planes.len(), good) };
    let mut procedure =
        Field::new(plan).map_err(|refusal| root.wrong("planes", format!("other settings: {refusal}")))?;
    let (mut entry, mut angles) = (Entry::new(), Entry::new());
    let mut common = Common { rows, convention, run_out: vec![Complex::new(0.0, 0.0); rows], baseline: None };
    let mut on = vec![Complex::new(0.0, 0.0); planes.len()];
    if root.has("run_out") {
        let mut table = root.table("run_out")?;
        common.run_out = pairs(&mut table, "readings", rows, &mut entry, convention, AngleConvention::reading)?;
        table.finish()?;
    }

    let mut table = root.table("baseline")?;
    let (run, baseline, rpm) = run(&mut table, &common, &mut entry)?;
    common.baseline = Some(rpm.clone());
    procedure.baseline(&run).map_err(|refusal| refused(&table, refusal))?;
    table.finish()?;
    let mut last = baseline.clone();

    let machine = choice(root, "machine", &[("none", false), ("hard-bearing", true)])?;
    if machine {
        if root.has("influence") {
            return Err(root.wrong("influence", "no [[influence]] beside `machine`: the places of the planes have it"));
        }
        let influence = hard_bearing(root, file, &rpm)?;
        procedure =
            procedure.with_coefficients(influence).map_err(|refusal| root.wrong("machine", refusal.to_string()))?;
    }
    let known = root.optional_tables("influence")?;
    if !known.is_empty() {
        let mut influence = Influence::<f64, ROWS, PLANES>::new(rows, planes.len())
            .map_err(|refusal| root.wrong("influence", refusal.to_string()))?;
        let mut phases = Entry::new();
        for mut table in known {
            let plane = plane(&mut table, planes)?;
            if influence.get(0, plane).is_some() {
                return Err(table.wrong("plane", "a plane that has no [[influence]] yet"));
            }
            let column = pairs(&mut table, "coefficients", rows, &mut phases, convention, AngleConvention::reading)?;
            convention
                .check(&phases)
                .map_err(|refusal| table.wrong("coefficients", format!("phases in degrees: {refusal}")))?;
            influence.set(plane, &column).map_err(|refusal| table.wrong("coefficients", refusal.to_string()))?;
            table.finish()?;
        }
        procedure = procedure
            .with_coefficients(influence)
            .map_err(|refusal| root.wrong("influence", format!("a table for each plane: {}", said(refusal, planes))))?;
    }
    let known = machine || root.has("influence");
    let mut changes = vec![None; planes.len()];
    for (count, mut table) in root.optional_tables("trial")?.into_iter().enumerate() {
        let plane = plane(&mut table, planes)?;
        if known {
            return Err(
                table.wrong("plane", "no trial run beside [[influence]] or `machine`: one of them, for all planes")
            );
        }
        if count == TRIALS {
            return Err(table.wrong("plane", format!("no more than {TRIALS} trial runs")));
        }
        let weight = weight(&mut table, "weight", &mut angles, convention)?;
        convention
            .check(&angles)
            .map_err(|refusal| table.wrong("weight", format!("an angle in degrees: {refusal}")))?;
        let (run, readings, _) = self::run(&mut table, &common, &mut entry)?;
        // several of a plane all count: replacing one would lose an entry
        procedure.extra_trial(plane, weight, &run).map_err(|refusal| refused(&table, refusal))?;
        let before = if leave_trials { &last } else { &baseline };
        let change = before.iter().zip(&readings).map(|(before, with)| (with - before).norm() / before.norm());
        changes[plane] = Some(change.fold(changes[plane].unwrap_or(0.0), f64::max));
        if leave_trials {
            last = readings;
            on[plane] += weight;
        }
        table.finish()?;
    }
    let mut corrections = 0;
    for mut table in root.optional_tables("correction")? {
        if corrections == CORRECTIONS {
            return Err(table.wrong("weights", format!("no more than {CORRECTIONS} corrections")));
        }
        let placed =
            pairs(&mut table, "weights", planes.len(), &mut Entry::new(), convention, AngleConvention::weight)?;
        for (on, weight) in on.iter_mut().zip(&placed) {
            *on += weight;
        }
        let mut all = [Complex::new(0.0, 0.0); PLANES];
        all[..placed.len()].copy_from_slice(&placed);
        procedure.installed(&all).map_err(|refusal| table.wrong("weights", said(refusal, planes)))?;
        let (run, readings, _) = self::run(&mut table, &common, &mut entry)?;
        procedure.verified(&run).map_err(|refusal| refused(&table, refusal))?;
        last = readings;
        corrections += 1;
        table.finish()?;
    }
    if let Err(refusal) = convention.check(&entry) {
        let mut table = root.table("baseline")?;
        let _ = table.has("readings");
        return Err(
            table.wrong("readings", format!("phases in degrees, or `angle_unit = \"radians\"` above it: {refusal}"))
        );
    }
    if let Some(plane) = procedure.influence().ok().and_then(|influence| influence.unknown()) {
        let expected = format!("a [[trial]] of plane \"{}\": its influence is not known", planes[plane]);
        let key = if root.has("trial") { "trial" } else { "planes" };
        return Err(root.wrong(key, expected));
    }
    // readings without a solution are a fault of the file
    procedure.correction().map_err(|refusal| {
        let key = ["limits", "aim", "baseline"].into_iter().find(|key| root.has(key)).unwrap_or("planes");
        root.wrong(key, format!("readings with a solution: {}", said(refusal, planes)))
    })?;
    Ok(Measured::Phasors { procedure: Box::new(procedure), baseline, last, rpm, on, corrections, changes })
}

/// The largest weight of each plane; `"none"` for a plane without a limit.
fn limits(table: &mut Table<'_>, count: usize) -> Result<Vec<Option<f64>>, Diagnostic> {
    if !table.has("limits") {
        return Ok(Vec::new());
    }
    let expected = format!("a list of {count} numbers, or \"none\" for a plane without a limit");
    let items = table.items("limits", &expected)?;
    if items.len() != count {
        return Err(table.wrong("limits", format!("{expected}, and not {}", items.len())));
    }
    let limit = |item: &Item<'_>| match item.text(&expected) {
        Ok("none") => Ok(None),
        _ => item.number(ABOVE_ZERO).map(Some),
    };
    items.iter().map(limit).collect()
}

/// A refusal with the planes by their names.
fn said(refusal: Error, planes: &[String]) -> String {
    match refusal {
        Error::PlaneUnknown { plane } => match planes.get(plane) {
            Some(name) => format!("the influence of plane \"{name}\" is not known: make its trial run"),
            None => refusal.to_string(),
        },
        _ => refusal.to_string(),
    }
}
