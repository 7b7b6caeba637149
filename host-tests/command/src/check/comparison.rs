//! Figures beside their budgets.

use std::fmt::{self, Display, Write};

use super::Count;
use driveline_qemu::measure::Cost;
use driveline_qemu::measure::budgets::{Budget, Budgets};

/// One figure and its budget.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Figure {
    /// Its name, as in `budgets.toml`.
    pub name: &'static str,
    /// Measurement.
    pub measured: u64,
    /// The most that it may be.
    pub budget: Option<u64>,
}

impl Figure {
    /// Whether it is more than its budget.
    pub fn is_over(&self) -> bool {
        self.budget.is_some_and(|budget| self.measured > budget)
    }
}

/// The figures of a variant on a core; no figures' budgets where the file has none for it.
#[derive(Clone, Debug)]
struct Row {
    variant: String,
    core: &'static str,
    has_budget: bool,
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
            let figures = figures(cost, &budget.unwrap_or_default());
            Row { variant: variant.clone(), core, has_budget: budget.is_some(), figures }
        };
        Comparison { rows: costs.iter().map(row).collect() }
    }

    /// Values over their budget or without one, by name.
    pub fn faults(&self) -> Vec<String> {
        let mut faults = Vec::new();
        for Row { variant, core, has_budget, figures } in &self.rows {
            if !has_budget {
                faults.push(format!(
                    "{variant} on {core} has no budget; for budgets.toml:\n{}",
                    proposal(variant, core, figures)
                ));
            }
            for Figure { name, measured, budget } in figures.iter().filter(|figure| figure.is_over()) {
                let budget = budget.unwrap_or_default();
                faults.push(format!("{variant} on {core}: {name} is {measured}, budget {budget}"));
            }
        }
        faults
    }

    /// Figures within their budgets, or what is not.
    pub fn count(&self) -> Result<Count, (Count, String)> {
        let faults = self.faults();
        let figures = self.rows.iter().flat_map(|row| &row.figures);
        let passed = figures.filter(|figure| figure.budget.is_some() && !figure.is_over()).count() as u64;
        let count = Count { passed, failed: faults.len() as u64 };
        if faults.is_empty() { Ok(count) } else { Err((count, faults.join("\n"))) }
    }
}

fn figures(cost: &Cost, budget: &Budget) -> [Figure; 6] {
    let figure = |name, measured, budget| Figure { name, measured, budget };
    let spread = cost.instructions;
    [
        figure("least instructions", spread.min.into(), None),
        figure("median instructions", spread.median.into(), None),
        figure("instructions", spread.max.into(), budget.instructions),
        figure("flash", cost.sizes.flash(), budget.flash),
        figure("ram", cost.sizes.ram(), budget.ram),
        figure("stack", cost.stack.into(), budget.stack),
    ]
}

/// The lines that would make today's figures the budget.
fn proposal(variant: &str, core: &str, figures: &[Figure; 6]) -> String {
    let (scene, rest) = variant.split_once('/').unwrap_or((variant, ""));
    let [_, _, limited @ ..] = figures;
    let limits: Vec<String> = limited.iter().map(|figure| format!("{} = {}", figure.name, figure.measured)).collect();
    format!("[{scene}]\n\"{rest}\".{core} = {{ {} }}\n", limits.join(", "))
}

impl Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let width = self.rows.iter().map(|row| row.variant.len()).max().unwrap_or(0).max(7);
        write!(f, "{:width$}  core", "variant")?;
        for name in ["min", "median", "max", "flash", "ram", "stack"] {
            write!(f, "  {name:>13}")?;
        }
        writeln!(f)?;
        for row in &self.rows {
            write!(f, "{:width$}  {:4}", row.variant, row.core)?;
            for figure in &row.figures {
                let mut place = format!("{}/", figure.measured);
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
    use driveline_qemu::measure::{Cost, Spread};

    const VARIANT: &str = "empty/f32/none/10000";
    const KEY: &str = "[empty]\n\"f32/none/10000\".m3";

    fn comparison(budgets: &str) -> Comparison {
        let cost = Cost {
            instructions: Spread { min: 5, median: 6, max: 7 },
            sizes: Sizes { text: 700, constants: 200, data: 4, zeroed: 8 },
            tick_code: 20,
            state: 8,
            stack: 16,
        };
        Comparison::of(&Budgets::parse(budgets).unwrap(), &[(VARIANT.into(), "m3", cost)])
    }

    #[test]
    fn a_figure_at_its_budget_passes_and_one_more_is_named() {
        let within = comparison(&format!("{KEY} = {{ instructions = 7, flash = 904, ram = 12 }}\n"));
        assert_eq!(within.count().map(|count| count.passed), Ok(3));
        let over = comparison(&format!("{KEY} = {{ instructions = 6, flash = 904, stack = 15 }}\n"));
        let (count, message) = over.count().unwrap_err();
        assert_eq!((count.passed, count.failed), (1, 2));
        assert_eq!(
            message,
            format!("{VARIANT} on m3: instructions is 7, budget 6\n{VARIANT} on m3: stack is 16, budget 15")
        );
        assert!(over.to_string().contains("7/6!"), "{over}");
    }

    #[test]
    fn a_variant_without_a_budget_is_named_with_the_lines_to_add() {
        let none = comparison("");
        let faults = none.faults();
        let lines = faults[0].split_once(":\n").unwrap().1;
        assert!(comparison(lines).faults().is_empty(), "{lines}");
    }
}
