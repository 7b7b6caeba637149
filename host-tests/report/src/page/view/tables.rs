//! The table of budgets.

use serde::Serialize;

use crate::format;
use crate::results::Budget;

/// A budget and its verdict.
#[derive(Serialize)]
pub struct Verdict {
    name: String,
    measured: String,
    limit: String,
    share: f64,
    kept: bool,
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
