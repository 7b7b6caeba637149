//! A section of the page.

use crate::survey::Survey;
use driveline_report::Table;

/// A section of the page.
#[derive(Clone, Debug, Default)]
pub(super) struct Section {
    pub(super) title: String,
    pub(super) text: String,
    pub(super) failures: Vec<String>,
    /// Each with its title and text.
    pub(super) tables: Vec<(String, String, Table)>,
}

impl Section {
    pub(super) fn new(title: &str, text: &str) -> Self {
        Self { title: title.to_owned(), text: text.to_owned(), ..Self::default() }
    }

    /// The same with a table.
    pub(super) fn table(mut self, title: &str, text: &str, table: &Table) -> Self {
        self.tables.push((title.to_owned(), text.to_owned(), table.clone()));
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

/// The verdict on something.
pub(super) const fn kept(is: bool) -> &'static str {
    if is { "kept" } else { "missed" }
}
