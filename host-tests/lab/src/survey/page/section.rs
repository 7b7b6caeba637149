//! A section of the page.

use serde::Serialize;

use crate::survey::Survey;
use driveline_report::Table;

/// A section of the page.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Section {
    pub(super) title: String,
    pub(super) text: String,
    pub(super) failures: Vec<String>,
    pub(super) tables: Vec<Shown>,
}

/// A table as the page shows it.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Shown {
    pub(super) title: String,
    pub(super) text: String,
    pub(super) headings: Vec<Cell>,
    pub(super) rows: Vec<Vec<Cell>>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct Cell {
    pub(super) text: String,
    class: String,
}

impl Section {
    pub(super) fn new(title: &str, text: &str) -> Self {
        Self { title: title.to_owned(), text: text.to_owned(), ..Self::default() }
    }

    /// The same with a table.
    pub(super) fn table(mut self, title: &str, text: &str, table: &Table) -> Self {
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
    pub(super) fn failed(mut self, survey: &Survey, place: &str) -> Self {
        let said = survey.failures_in(place).map(|failure| format!("{}: {}", failure.job, failure.reason));
        self.failures.extend(said);
        self
    }

    pub(super) fn is_empty(&self) -> bool {
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
pub(super) const fn kept(is: bool) -> &'static str {
    if is { "kept" } else { "missed" }
}
