//! The page of a machine: its natural vibrations and what it was reduced to.

use serde::Serialize;

use super::chart::{Response, Station, mode_shape, response};
use super::page::fill;
use super::results::Fact;
use super::table::Table;

/// What there is to show of a machine.
#[derive(Clone, Debug, Default)]
pub struct MachinePage {
    /// Its name.
    pub name: String,
    /// What it is, in a sentence.
    pub summary: String,
    /// Its quantities.
    pub facts: Vec<Fact>,
    /// Its masses, from the motor.
    pub stations: Vec<Station>,
    /// Its vibrations, from the lowest.
    pub modes: Vec<ModeFigure>,
    /// Frequencies of the responses \[Hz\].
    pub frequency: Vec<f64>,
    /// What the motor feels: the whole chain and its reductions.
    pub responses: Vec<Response>,
    /// The Campbell diagram as an `<svg>` element, where there is one.
    pub campbell: Option<String>,
    /// Tables as title, text and table.
    pub tables: Vec<(String, String, Table)>,
}

/// A vibration to draw.
#[derive(Clone, Debug)]
pub struct ModeFigure {
    /// What stands over it: number and frequency.
    pub title: String,
    /// Amplitude of each station, in any scale.
    pub shape: Vec<f64>,
}

/// What the template is given.
#[derive(Serialize)]
struct View<'a> {
    name: &'a str,
    summary: &'a str,
    facts: &'a [Fact],
    modes: Vec<String>,
    legend: Vec<Curve<'a>>,
    response: Option<String>,
    campbell: &'a Option<String>,
    tables: Vec<Section<'a>>,
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

impl MachinePage {
    /// The page as HTML, one file.
    pub fn page(&self) -> String {
        let drawn = |mode: &ModeFigure| mode_shape(&self.stations, &mode.shape, &mode.title);
        let view = View {
            name: &self.name,
            summary: &self.summary,
            facts: &self.facts,
            modes: self.modes.iter().map(drawn).collect(),
            legend: self.responses.iter().map(|item| Curve { name: &item.name, class: &item.class }).collect(),
            response: (!self.responses.is_empty()).then(|| response(&self.frequency, &self.responses)),
            campbell: &self.campbell,
            tables: self
                .tables
                .iter()
                .map(|(title, text, table)| Section { title, text, headings: table.headings(), rows: table.filled() })
                .collect(),
        };
        fill("machine.html", view)
    }
}
