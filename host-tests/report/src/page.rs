//! Puts the report on one page.

use minijinja::value::Serde;
use minijinja::{AutoEscape, Environment};
use serde::Serialize;

use crate::chart;
use crate::format::significant;
use crate::report::Report;
use crate::results::Budget;
use crate::sample::{SAMPLES, samples_table};
use crate::sheet::{Figure, Key, Section, Sheet};
use crate::table::{Table, variants_table};

/// The page's template and its parts, compiled into the program.
const TEMPLATES: &[(&str, &str)] = &[
    ("sheet.html", include_str!("page/sheet.html")),
    ("frame.html", include_str!("page/frame.html")),
    ("style.css", include_str!("page/style.css")),
    ("viewer.js", include_str!("page/viewer.js")),
];

/// Courses on a page at most, and stretches into which each line of one is cut: the page stays below 3 MB.
const COURSES: usize = 16;
const STRETCHES: usize = 400;

/// Fills a template. Everything is escaped but what is marked as safe: our own SVG and style.
///
/// # Panics
/// Where a template is wrong, which the tests show: the templates are part of the program.
pub fn fill(template: &str, values: impl Serialize) -> String {
    let mut environment = Environment::new();
    environment.set_auto_escape_callback(
        |name| {
            if name.ends_with(".html") { AutoEscape::Html } else { AutoEscape::None }
        },
    );
    for &(name, text) in TEMPLATES {
        environment.add_template(name, text).expect("a template of the report is not well-formed");
    }
    let template = environment.get_template(template).expect("the report's template is compiled in");
    template.render(Serde(values)).expect("a template of the report lacks an input")
}

impl Report {
    /// The page as HTML. Long series are thinned (peaks kept) so that it stays under 3 MB.
    pub fn page(&self) -> String {
        let mut tables = Vec::new();
        if !self.samples.is_empty() {
            let (text, table) = samples_table(&self.samples);
            tables.push(Section::new(SAMPLES, text.replace('`', ""), table));
        }
        let text = "Errors: torque as a share of its peak, speed of the rated speed.";
        tables.push(Section::new("Variants", text, variants_table(&self.variants)));
        if !self.budgets.is_empty() {
            tables.push(Section::new("Budgets", "", budgets_table(&self.budgets)));
        }
        tables.push(Section::new("Measured, and only estimated", self.notes.join(" "), Table::default()));
        let shown = self.trajectories.iter().take(COURSES);
        let text = "Truth from the full solver, the estimate from the motor's angle and torque alone, and under each \
                    their difference.";
        let legend = ["truth", "estimate", "error"].map(|class| Key::curve(class, class));
        let courses = shown.map(|trajectory| {
            let title = format!("{}, {}", trajectory.situation, trajectory.variant);
            Figure::new(title, text, legend.to_vec(), vec![chart::course(trajectory, STRETCHES)])
        });
        Sheet {
            name: self.scene.clone(),
            kicker: "measured against the full solver".to_owned(),
            summary: self.summary.clone(),
            facts: self.facts.clone(),
            figures: courses.collect(),
            tables,
        }
        .page()
    }

    /// Output of `run --json`: `{scene, variants}`.
    pub fn json(&self) -> serde_json::Value {
        serde_json::json!({ "scene": self.scene, "variants": self.variants })
    }
}

fn budgets_table(budgets: &[Budget]) -> Table {
    let mut table = Table::new(["what", "measured", "at most", "verdict"]);
    for budget in budgets {
        let [measured, limit] = [budget.measured, budget.limit].map(|value| {
            let number = significant(value);
            if budget.unit.is_empty() || !value.is_finite() { number } else { format!("{number} {}", budget.unit) }
        });
        let verdict = if budget.kept() { "kept" } else { "exceeded" };
        table.row([budget.name.as_str(), &measured, &limit, verdict]);
    }
    table
}
