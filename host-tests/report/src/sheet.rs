//! A page of figures and tables under a heading, for commands that show one thing.

use std::fmt;

use serde::Serialize;

use super::chart::{Line, over_time};
use super::page::fill;
use super::results::Fact;
use super::table::Table;

/// A page: what it is of, figures, tables.
#[derive(Clone, Debug, Default)]
pub struct Sheet {
    /// Name of the thing.
    pub name: String,
    /// Heading on the page: two or three words.
    pub kicker: String,
    /// Description, in a sentence.
    pub summary: String,
    /// Its quantities.
    pub facts: Vec<Fact>,
    pub figures: Vec<Figure>,
    pub tables: Vec<Section>,
}

/// A section with plots.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Figure {
    pub title: String,
    /// Caption, in a sentence or two.
    pub text: String,
    /// What the curves or arrows are.
    pub legend: Vec<Key>,
    /// The plots as `<svg>`.
    pub plots: Vec<String>,
    /// How the plots stand.
    pub arrangement: Arrangement,
}

impl Figure {
    /// With its plots one below the other.
    pub fn new(title: impl Into<String>, text: impl Into<String>, legend: Vec<Key>, plots: Vec<String>) -> Self {
        Self { title: title.into(), text: text.into(), legend, plots, arrangement: Arrangement::Below }
    }

    /// One plot of lines over time (s) with `quantity` at its axis; `marks` are times of events.
    pub fn over_time(title: &str, text: String, time: &[f64], lines: &[Line], quantity: &str, marks: &[f64]) -> Self {
        let legend = lines.iter().map(|line| Key::curve(&*line.name, &*line.class)).collect();
        Self::new(title, text, legend, vec![over_time(time, lines, quantity, marks)])
    }
}

/// How the plots of a figure stand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Arrangement {
    /// One below the other, each as wide as the page.
    #[default]
    Below,
    /// Beside each other.
    Beside,
    /// Two beside each other.
    Paired,
}

/// A line of a legend.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Key {
    /// What it stands for.
    pub name: String,
    /// Its style class, a colour.
    pub class: String,
    /// An arrow, not a curve.
    pub arrow: bool,
}

impl Key {
    pub fn curve(name: impl Into<String>, class: impl Into<String>) -> Self {
        Self { name: name.into(), class: class.into(), arrow: false }
    }

    /// Of an arrow in a polar plot.
    pub fn arrow(name: impl Into<String>, class: impl Into<String>) -> Self {
        Self { arrow: true, ..Self::curve(name, class) }
    }
}

/// A section with a table. On a terminal the text is left out.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Section {
    pub title: String,
    /// What is in it, in a sentence or two.
    pub text: String,
    pub table: Table,
}

impl Section {
    pub fn new(title: impl Into<String>, text: impl Into<String>, table: Table) -> Self {
        Self { title: title.into(), text: text.into(), table }
    }
}

impl fmt::Display for Section {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}\n{}", self.title, self.table)
    }
}

#[derive(Serialize)]
struct View<'a> {
    name: &'a str,
    kicker: &'a str,
    summary: &'a str,
    facts: &'a [Fact],
    figures: &'a [Figure],
    tables: Vec<Shown<'a>>,
}

#[derive(Serialize)]
struct Shown<'a> {
    title: &'a str,
    text: &'a str,
    headings: &'a [String],
    rows: Vec<Vec<String>>,
}

impl Sheet {
    /// The page as HTML, one file.
    #[must_use]
    pub fn page(&self) -> String {
        let tables = self.tables.iter();
        let view = View {
            name: &self.name,
            kicker: &self.kicker,
            summary: &self.summary,
            facts: &self.facts,
            figures: &self.figures,
            tables: tables
                .map(|Section { title, text, table }| Shown {
                    title,
                    text,
                    headings: table.headings(),
                    rows: table.filled(),
                })
                .collect(),
        };
        fill("sheet.html", view)
    }
}
