//! Figures beside their budgets.

use std::fmt::{self, Display, Write};

use super::Count;
use driveline_qemu::measure::budgets::{Budget, Budgets, most};
use driveline_qemu::measure::{Bound, Cost, Refusal};

/// One figure and its budget.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Figure {
    /// Its name, as in `budgets.toml`.
    pub name: &'static str,
    /// Measurement, or why there is none.
    pub measured: Result<u64, String>,
    /// The most that it may be.
    pub budget: Option<u64>,
    /// The figure that the file has.
    pub noted: Option<u64>,
}

impl Figure {
    /// Whether it is more than its budget, or has a budget and is not known.
    pub fn is_over(&self) -> bool {
        self.budget.is_some_and(|budget| !self.measured.as_ref().is_ok_and(|measured| *measured <= budget))
    }

    /// The measurement, where the file's figure leaves more room above it than a limit does.
    fn outdated(&self) -> Option<(u64, u64)> {
        let (noted, measured) = (self.noted?, *self.measured.as_ref().ok()?);
        (noted > most(self.name, measured)).then_some((noted, measured))
    }
}

/// The figures of a variant on a core; no figures' budgets where the file has none for it.
#[derive(Clone, Debug)]
struct Row {
    variant: String,
    core: &'static str,
    has_budget: bool,
    /// Whether the file says that there is no bound.
    unbounded: bool,
    figures: [Figure; 6],
}

/// Costs beside budgets. Displayed as a table, `measured/budget` in every place.
#[derive(Clone, Debug)]
pub struct Comparison {
    rows: Vec<Row>,
}

impl Comparison {
    /// Of costs by variant and core.
    pub fn of(budgets: &Budgets, costs: &[(String, &'static str, Cost)]) -> Self {
        let row = |(variant, core, cost): &(String, &'static str, Cost)| {
            let budget = budgets.of(variant, core);
            let (has_budget, budget) = (budget.is_some(), budget.unwrap_or_default());
            let figures = figures(cost, &budget);
            Row { variant: variant.clone(), core, has_budget, unbounded: budget.unbounded, figures }
        };
        Comparison { rows: costs.iter().map(row).collect() }
    }

    /// Values over their budget or without one, by name.
    pub fn faults(&self) -> Vec<String> {
        let mut faults = Vec::new();
        for Row { variant, core, has_budget, unbounded, figures } in &self.rows {
            let longest = figures.iter().find(|figure| figure.name == "longest");
            if let Some(Ok(longest)) = longest.map(|figure| &figure.measured).filter(|_| *unbounded) {
                faults.push(format!(
                    "{variant} on {core}: longest is {longest}, and no more `unbounded`; give it a limit"
                ));
            }
            if !has_budget {
                faults.push(format!(
                    "{variant} on {core} has no budget; for budgets.toml:\n{}",
                    proposal(variant, core, figures)
                ));
            }
            for Figure { name, measured, budget, .. } in figures.iter().filter(|figure| figure.is_over()) {
                let budget = budget.unwrap_or_default();
                faults.push(match measured {
                    Ok(measured) => format!("{variant} on {core}: {name} is {measured}, budget {budget}"),
                    Err(reason) => format!("{variant} on {core}: {name} has a budget, but no bound: {reason}"),
                });
            }
            for (name, (noted, measured)) in figures.iter().filter_map(|figure| Some((figure.name, figure.outdated()?)))
            {
                faults.push(format!(
                    "{variant} on {core}: {name} is {measured}, budgets.toml has {noted}: write it anew"
                ));
            }
        }
        faults
    }

    /// Figures within their budgets, or what is not.
    pub fn count(&self) -> Result<Count, (Count, String)> {
        let faults = self.faults();
        let figures = self.rows.iter().flat_map(|row| &row.figures);
        let passed = figures.filter(|figure| figure.budget.is_some() && !figure.is_over()).count() as u64;
        let count = Count { passed, failed: faults.len() as u64, skipped: 0 };
        if faults.is_empty() { Ok(count) } else { Err((count, faults.join("\n"))) }
    }
}

fn figures(cost: &Cost, noted: &Budget) -> [Figure; 6] {
    let limits = noted.limits();
    let figure = |name, measured, budget, noted| Figure { name, measured: Ok(measured), budget, noted };
    let bound = |name, of: fn(&Bound) -> u64, budget, noted| {
        let measured = cost.bound.as_ref().map(of).map_err(Refusal::to_string);
        Figure { name, measured, budget, noted }
    };
    // one limit for both; a stack that is only painted has no other
    let is_bounded = cost.bound.is_ok();
    [
        figure("median", cost.instructions.median.into(), limits.median, noted.median),
        bound("longest", |bound| bound.instructions, limits.longest, noted.longest),
        figure("flash", cost.sizes.flash(), limits.flash, noted.flash),
        figure("ram", cost.sizes.ram(), limits.ram, noted.ram),
        figure("stack", cost.stack.into(), limits.stack, noted.stack.filter(|_| !is_bounded)),
        bound("stack bound", |bound| bound.stack.into(), limits.stack.filter(|_| is_bounded), noted.stack),
    ]
}

/// The lines that would make today's figures the budget.
fn proposal(variant: &str, core: &str, figures: &[Figure; 6]) -> String {
    let (scene, rest) = variant.split_once('/').unwrap_or((variant, ""));
    let [limited @ .., bound] = figures;
    let known = limited.iter().filter_map(|figure| Some((figure.name, *figure.measured.as_ref().ok()?)));
    // the stack's limit holds its bound, too
    let deeper = |name| if name == "stack" { bound.measured.clone().unwrap_or(0) } else { 0 };
    let limits = known.map(|(name, measured)| format!("{name} = {}", measured.max(deeper(name))));
    let limits: Vec<String> = limits.collect();
    format!("[{scene}]\n\"{rest}\".{core} = {{ {} }}\n", limits.join(", "))
}

impl Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let width = self.rows.iter().map(|row| row.variant.len()).max().unwrap_or(0).max(7);
        write!(f, "{:width$}  core", "variant")?;
        for name in ["median", "longest", "flash", "ram", "stack", "stack bound"] {
            write!(f, "  {name:>13}")?;
        }
        writeln!(f)?;
        for row in &self.rows {
            write!(f, "{:width$}  {:4}", row.variant, row.core)?;
            for figure in &row.figures {
                let mut place = match figure.measured {
                    Ok(measured) => format!("{measured}/"),
                    Err(_) => "none/".into(),
                };
                match figure.budget {
                    Some(budget) => write!(place, "{budget}")?,
                    None => place.push('-'),
                }
                place.push_str(if figure.is_over() { "!" } else { " " });
                write!(f, "  {place:>13}")?;
            }
            writeln!(f)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::Comparison;
    use driveline_qemu::image::Sizes;
    use driveline_qemu::measure::budgets::Budgets;
    use driveline_qemu::measure::{Bound, Cost, Spread};

    const VARIANT: &str = "empty/f32/none/10000";
    const KEY: &str = "[empty]\n\"f32/none/10000\".m3";

    fn comparison(budgets: &str) -> Comparison {
        let bound = Ok(Bound { instructions: 9, stack: 24 });
        let cost = Cost {
            instructions: Spread { min: 5, median: 6, max: 7 },
            bound,
            sizes: Sizes { text: 700, constants: 200, data: 4, zeroed: 8 },
            tick_code: 20,
            state: 8,
            stack: 16,
        };
        Comparison::of(&Budgets::parse(budgets).unwrap(), &[(VARIANT.into(), "m3", cost)])
    }

    #[test]
    fn a_figure_at_its_budget_passes_and_one_more_is_named() {
        // limits of 6, 904 and 14
        let within = comparison(&format!("{KEY} = {{ median = 5, flash = 821, ram = 6 }}\n"));
        assert_eq!(within.count().map(|count| count.passed), Ok(3));
        let over = comparison(&format!("{KEY} = {{ median = 4, flash = 821, stack = 7 }}\n"));
        let (count, message) = over.count().unwrap_err();
        assert_eq!((count.passed, count.failed), (1, 3));
        let faults = ["median is 6, budget 5", "stack is 16, budget 15", "stack bound is 24, budget 15"];
        assert_eq!(message, faults.map(|fault| format!("{VARIANT} on m3: {fault}")).join("\n"));
        assert!(over.to_string().contains("6/5!"), "{over}");
    }
}
