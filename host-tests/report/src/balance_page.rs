//! The page of a balancing: vibrations and weights as polar plots, and the tables.

use serde::Serialize;

use super::page::fill;
use super::results::Fact;
use super::table::Table;

/// What there is to show of a balancing.
#[derive(Clone, Debug, Default)]
pub struct BalancePage {
    /// The rotor's name.
    pub name: String,
    /// The outcome, in a sentence.
    pub summary: String,
    /// Its quantities.
    pub facts: Vec<Fact>,
    /// Polar plots that belong together.
    pub figures: Vec<PolarFigure>,
    /// Tables as title, text and table.
    pub tables: Vec<(String, String, Table)>,
}

/// Polar plots with one legend.
#[derive(Clone, Debug, Serialize)]
pub struct PolarFigure {
    /// What stands over it.
    pub title: String,
    /// What is to be seen.
    pub text: String,
    /// Names of the arrows and their classes.
    pub legend: Vec<PolarKey>,
    /// The plots as SVG.
    pub plots: Vec<String>,
}

/// A line of a legend.
#[derive(Clone, Debug, Serialize)]
pub struct PolarKey {
    /// What the arrows are.
    pub name: &'static str,
    /// Their class, a colour.
    pub class: &'static str,
}

#[derive(Serialize)]
struct View<'a> {
    name: &'a str,
    summary: &'a str,
    facts: &'a [Fact],
    figures: &'a [PolarFigure],
    tables: Vec<Section>,
}

#[derive(Serialize)]
struct Section {
    title: String,
    text: String,
    headings: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl BalancePage {
    /// The page as HTML, one file.
    pub fn page(&self) -> String {
        let section = |(title, text, table): &'_ (String, String, Table)| Section {
            title: title.clone(),
            text: text.clone(),
            headings: table.headings().to_vec(),
            rows: table.filled(),
        };
        let tables = self.tables.iter().map(section).collect();
        fill(
            "balance.html",
            View { name: &self.name, summary: &self.summary, facts: &self.facts, figures: &self.figures, tables },
        )
    }
}
