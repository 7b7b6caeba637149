//! A page of facts, tables and plots over time.

use serde::Serialize;

use super::page::fill;
use super::results::Fact;
use super::table::Table;

/// What there is to show.
#[derive(Clone, Debug, Default)]
pub struct PlotsPage {
    /// What stands above the title.
    pub kicker: String,
    /// The title.
    pub name: String,
    /// What it is, in a sentence or two.
    pub summary: String,
    /// Quantities.
    pub facts: Vec<Fact>,
    /// Tables as title, text and table.
    pub tables: Vec<(String, String, Table)>,
    /// Plots as title, text and SVG.
    pub plots: Vec<(String, String, String)>,
}

#[derive(Serialize)]
struct View<'a> {
    kicker: &'a str,
    name: &'a str,
    summary: &'a str,
    facts: &'a [Fact],
    tables: Vec<Section<'a>>,
    plots: &'a [(String, String, String)],
}

#[derive(Serialize)]
struct Section<'a> {
    title: &'a str,
    text: &'a str,
    headings: &'a [String],
    rows: Vec<Vec<String>>,
}

impl PlotsPage {
    /// The page as HTML, one file.
    pub fn page(&self) -> String {
        let tables = self.tables.iter().map(|(title, text, table)| Section {
            title,
            text,
            headings: table.headings(),
            rows: table.filled(),
        });
        let view = View {
            kicker: &self.kicker,
            name: &self.name,
            summary: &self.summary,
            facts: &self.facts,
            tables: tables.collect(),
            plots: &self.plots,
        };
        fill("plots.html", view)
    }
}
