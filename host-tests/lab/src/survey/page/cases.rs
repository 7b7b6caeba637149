//! Stiff and extreme cases.

use super::{Section, kept};
use crate::survey::CASES;
use crate::survey::Survey;
use driveline_report::Table;

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
