//! The page of a simulation: lines over time, and the tables.

use serde::Serialize;

use super::chart::{Line, over_time};
use super::page::fill;
use super::results::Fact;
use super::table::Table;

/// What there is to show of a simulation.
#[derive(Clone, Debug, Default)]
pub struct SimulationPage {
    /// Name of the machine.
    pub name: String,
    /// What was run, in a sentence.
    pub summary: String,
    /// Its figures.
    pub facts: Vec<Fact>,
    /// Times of the lines \[s\].
    pub time: Vec<f64>,
    /// Times of events \[s\].
    pub marks: Vec<f64>,
    /// Plots as title, text, what stands at the axis, and lines.
    pub plots: Vec<(String, String, String, Vec<Line>)>,
    /// Tables as title, text and table.
    pub tables: Vec<(String, String, Table)>,
}

#[derive(Serialize)]
struct View<'a> {
    name: &'a str,
    summary: &'a str,
    facts: &'a [Fact],
    plots: Vec<Plot<'a>>,
    tables: Vec<Section<'a>>,
}

#[derive(Serialize)]
struct Plot<'a> {
    title: &'a str,
    text: &'a str,
    legend: Vec<Curve<'a>>,
    drawing: String,
}

#[derive(Serialize)]
struct Curve<'a> {
    name: &'a str,
    class: &'a str,
}

#[derive(Serialize)]
struct Section<'a> {
    title: &'a str,
    text: &'a str,
    headings: &'a [String],
    rows: Vec<Vec<String>>,
}

impl SimulationPage {
    /// The page as HTML, one file.
    pub fn page(&self) -> String {
        let plots = self.plots.iter().map(|(title, text, axis, drawn)| Plot {
            title,
            text,
            legend: drawn.iter().map(|line| Curve { name: &line.name, class: &line.class }).collect(),
            drawing: over_time(&self.time, drawn, axis, &self.marks),
        });
        let tables = self.tables.iter();
        let view = View {
            name: &self.name,
            summary: &self.summary,
            facts: &self.facts,
            plots: plots.collect(),
            tables: tables
                .map(|(title, text, table)| Section { title, text, headings: table.headings(), rows: table.filled() })
                .collect(),
        };
        fill("simulation.html", view)
    }
}
