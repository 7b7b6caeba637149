//! The page of `report`: every scene, every variant and every stiff case, with verdicts.

mod balancing;
mod cases;
mod commissioning;
mod factors;
mod front;
mod generator;
mod scenes;
mod sizes;

use serde::Serialize;

use crate::survey::{Survey, adapters};
use driveline_report::page::fill;
use driveline_report::page::view::{Costs, Sweeps};
use driveline_report::{Fact, Table};

/// A section of the page.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Section {
    title: String,
    text: String,
    failures: Vec<String>,
    reasons: Vec<String>,
    tables: Vec<Shown>,
}

/// A table as the page shows it.
#[derive(Clone, Debug, Serialize)]
struct Shown {
    title: String,
    text: String,
    headings: Vec<Cell>,
    rows: Vec<Vec<Cell>>,
}

#[derive(Clone, Debug, Serialize)]
struct Cell {
    text: String,
    class: String,
}

#[derive(Serialize)]
struct View {
    summary: String,
    facts: Vec<Fact>,
    front: Costs,
    before: Vec<Section>,
    scenes: Vec<Section>,
    after: Vec<Section>,
    sweeps: Sweeps,
    last: Vec<Section>,
}

impl Section {
    fn new(title: &str, text: &str) -> Self {
        Self { title: title.to_owned(), text: text.to_owned(), ..Self::default() }
    }

    /// The same with a table.
    fn table(mut self, title: &str, text: &str, table: &Table) -> Self {
        let shown = |column: usize, text: &str| {
            // a sentence is broken over lines, a number never
            let kind = match table.numeric(column) {
                true => "n",
                false if text.chars().count() > 24 => "long",
                false => "",
            };
            Cell { text: text.to_owned(), class: format!("{kind} {}", verdict(text)).trim().to_owned() }
        };
        let rows = table.filled();
        self.tables.push(Shown {
            title: title.to_owned(),
            text: text.to_owned(),
            headings: table.headings().iter().enumerate().map(|(column, text)| shown(column, text)).collect(),
            rows: rows
                .iter()
                .map(|row| row.iter().enumerate().map(|(column, text)| shown(column, text)).collect())
                .collect(),
        });
        self
    }

    /// The same with what failed in a place.
    fn failed(mut self, survey: &Survey, place: &str) -> Self {
        let said = survey.failures_in(place).map(|failure| format!("{}: {}", failure.job, failure.reason));
        self.failures.extend(said);
        self
    }

    fn is_empty(&self) -> bool {
        self.tables.is_empty() && self.failures.is_empty()
    }
}

/// How a cell's text is coloured: words that are verdicts.
fn verdict(text: &str) -> &'static str {
    match text.split([' ', ':']).next().unwrap_or_default() {
        "kept" | "equal" => "met",
        "missed" | "differ" | "diverged" | "NO" | "YES" | "failed" => "failed",
        _ => "",
    }
}

/// The verdict on something.
const fn kept(is: bool) -> &'static str {
    if is { "kept" } else { "missed" }
}

/// What the page shows, and what it does not.
fn summary(survey: &Survey) -> String {
    let whole = "Every scene in all its variants in QEMU, tick by tick against the full solver of its machine; and every stiff or extreme case \
                 beside its reference.";
    let part = "The scenes that were asked for in all their variants in QEMU, tick by tick against the full solver of the machine.";
    let quick = " A quick run: two seconds of each drivetrain, unproven. Not for figures to quote.";
    format!("{}{}", if survey.part { part } else { whole }, if survey.quick { quick } else { "" })
}

/// The page as HTML, one file.
pub fn survey_page(survey: &Survey) -> String {
    let sections = |all: Vec<Section>| all.into_iter().filter(|section| !section.is_empty()).collect();
    fill(
        "survey.html",
        View {
            summary: summary(survey),
            facts: scenes::facts(survey),
            front: front::costs(survey),
            before: sections(vec![scenes::overview(survey), front::section(survey)]),
            scenes: survey.scenes.iter().map(|scene| scenes::section(survey, scene)).collect(),
            after: sections(vec![
                sizes::section(survey),
                factors::section(survey),
                cases::section(survey),
                cases::reversals(survey),
            ]),
            sweeps: Sweeps::of(&survey.sweeps),
            last: sections(vec![
                cases::sweep_failures(survey),
                generator::section(survey),
                balancing::section(survey),
                commissioning::section(survey),
                Section::new(
                    "Every fault of every adapter",
                    "From doc/adapters.md, which a test writes from runs on mocked buses and compares ever since.",
                )
                .table("", "", &adapters()),
            ]),
        },
    )
}

/// The table of all scenes beside their aims, for the terminal.
pub fn survey_table(survey: &Survey) -> Table {
    scenes::overview_table(survey)
}
