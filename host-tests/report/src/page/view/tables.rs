//! The tables of steps, sweeps, sizes and budgets.

use serde::Serialize;

use crate::chart;
use crate::format;
use crate::format::{grouped, percent};
use crate::results::{Budget, Comparison, Composition};
use crate::sweep::{Slice, Sweep};

/// A sweep: its maps and its table.
#[derive(Serialize)]
pub struct SweepView {
    name: String,
    criterion: String,
    failures: usize,
    total: usize,
    maps: Vec<String>,
    rows: Vec<Vec<String>>,
}

/// Flash and RAM of a composition, the bars in percent of the largest.
#[derive(Serialize)]
pub struct Size {
    cells: Vec<String>,
    flash: f64,
    ram: f64,
}

/// A budget and its verdict.
#[derive(Serialize)]
pub struct Verdict {
    name: String,
    measured: String,
    limit: String,
    share: f64,
    kept: bool,
}

/// The table of steps.
pub fn compared(rows: &[Comparison]) -> Vec<Vec<String>> {
    let row = |row: &Comparison| {
        let errors = [row.shaft_torque, row.load_speed, row.load_torque];
        let mut cells = vec![row.step.clone(), row.observer.clone(), format::rate(row.rate_hz)];
        cells.extend(errors.into_iter().flat_map(|error| [percent(error.rms), percent(error.max)]));
        cells
    };
    rows.iter().map(row).collect()
}

/// A sweep's maps and table.
pub fn sweep(sweep: &Sweep) -> SweepView {
    let slices = sweep.slices();
    let row = |slice: &Slice<'_>| {
        let mut cells = vec![
            format::significant_short(slice.damping),
            slice.points.len().to_string(),
            slice.failures().to_string(),
        ];
        if let Some(worst) = slice.worst() {
            cells.push(format::significant(worst.error));
            cells.push(format!(
                "ωT {}, inertia ratio {}",
                format::significant_short(worst.omega_t),
                format::significant_short(worst.inertia_ratio)
            ));
        }
        cells
    };
    SweepView {
        name: sweep.name.clone(),
        criterion: sweep.criterion.clone(),
        failures: sweep.failures(),
        total: sweep.points.len(),
        maps: slices.iter().map(chart::heat_map).collect(),
        rows: slices.iter().map(row).collect(),
    }
}

/// Legend of the classes of error of a heat map.
pub fn classes() -> Vec<String> {
    let bound = |bound: &f64| format!("≤ {}", format::power(bound.log10().round() as i32));
    chart::CLASSES.iter().map(bound).chain(["more".to_owned()]).collect()
}

/// The table of flash and RAM.
pub fn sizes(compositions: &[Composition]) -> Vec<Size> {
    let largest = |size: fn(&Composition) -> u64| compositions.iter().map(size).max().unwrap_or(0).max(1) as f64;
    let (flash, ram) = (largest(Composition::flash), largest(Composition::ram));
    let size = |c: &Composition| {
        let bytes = [c.text_bytes, c.rodata_bytes, c.data_bytes, c.bss_bytes, c.flash(), c.ram()];
        let mut cells = vec![c.name.clone(), c.number.clone(), c.core.clone()];
        cells.extend(bytes.map(|bytes| grouped(bytes as i64)));
        Size { cells, flash: 100.0 * c.flash() as f64 / flash, ram: 100.0 * c.ram() as f64 / ram }
    };
    compositions.iter().map(size).collect()
}

/// A budget against what was measured.
pub fn verdict(budget: &Budget) -> Verdict {
    let with_unit = |value: f64| {
        let number = format::significant(value);
        if budget.unit.is_empty() || !value.is_finite() { number } else { format!("{number} {}", budget.unit) }
    };
    let used = budget.measured / budget.limit * 100.0;
    Verdict {
        name: budget.name.clone(),
        measured: with_unit(budget.measured),
        limit: with_unit(budget.limit),
        share: if used.is_finite() { used.clamp(0.0, 100.0) } else { 100.0 },
        kept: budget.kept(),
    }
}
