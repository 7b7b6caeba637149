//! Stiff and extreme cases.

use super::{Section, kept};
use crate::survey::Survey;
use crate::survey::{CASES, REVERSALS, SWEEP};
use driveline_report::Table;
use driveline_report::format::percent;

/// Published and made-up cases, each beside its reference.
pub fn section(survey: &Survey) -> Section {
    let mut table = Table::new(["kind", "case", "compared", "largest error", "at most", "verdict"]);
    for case in &survey.cases {
        table.row([
            case.group.to_owned(),
            case.name.clone(),
            case.compared.to_owned(),
            format!("{:.1e}", case.found),
            format!("{:.0e}", case.allowed),
            kept(case.holds()).to_owned(),
        ]);
    }
    let text = "Each against a reference that is not this project's code: 40-digit arithmetic or a published case. \
        Errors are relative.";
    let section = Section::new("Stiff and extreme cases", text).failed(survey, CASES);
    if survey.cases.is_empty() { section } else { section.table("", "", &table) }
}

/// Random reversals through backlash.
pub fn reversals(survey: &Survey) -> Section {
    let section = Section::new("Random reversals through backlash", "").failed(survey, REVERSALS);
    let Some(comparison) = &survey.backlash else { return section };
    let limit = crate::survey::Aim::BACKLASH.shaft_torque;
    let mut verdict =
        Table::new(["approach", "shaft torque rms, mean", "limit", "verdict", "worst run", "load speed rms"]);
    for row in &comparison.rows {
        verdict.row([
            row.approach.to_owned(),
            percent(row.shaft_torque),
            percent(limit),
            kept(row.shaft_torque <= limit).to_owned(),
            percent(row.worst),
            percent(row.load_speed),
        ]);
    }
    let numbers: Vec<String> =
        comparison.rows.iter().enumerate().map(|(index, row)| format!("{} {}", index + 1, row.approach)).collect();
    let text = format!(
        "{} runs of {} s of six machines with a gap of {} mrad through the full solver: approaches to an observer with \
            a gap.",
        comparison.courses.len(),
        comparison.seconds,
        1e3 * comparison.gap
    );
    Section { text, ..section }.table("", "", &verdict).table(
        "Run by run",
        &format!("Shaft torque, rms of peak. {}.", numbers.join("; ")),
        &comparison.by_course(),
    )
}

/// Error of the sweep.
pub fn sweep_failures(survey: &Survey) -> Section {
    Section::new("Stiff and extreme machines", "").failed(survey, SWEEP)
}
