//! A page of figures and tables under a heading, for commands that show one thing.

use serde::Serialize;

use super::page::fill;
use super::results::Fact;
use super::table::Table;

/// A page: what it is of, figures, tables.
#[derive(Clone, Debug, Default)]
pub struct Sheet {
    /// Name of the thing.
    pub name: String,
    /// What the page shows of it: two or three words.
    pub kicker: String,
    /// What it is, in a sentence.
    pub summary: String,
    /// Its quantities.
    pub facts: Vec<Fact>,
    /// The figures.
    pub figures: Vec<Figure>,
    /// Tables as title, text and table.
    pub tables: Vec<(String, String, Table)>,
}

/// A section with plots.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Figure {
    /// Title.
    pub title: String,
    /// What is to be seen, in a sentence or two.
    pub text: String,
    /// Names and style classes of the curves.
    pub legend: Vec<(String, String)>,
    /// The plots as `<svg>`, one below the other.
    pub plots: Vec<String>,
    /// Whether the plots stand beside each other.
    pub beside: bool,
}

#[derive(Serialize)]
struct View<'a> {
    name: &'a str,
    kicker: &'a str,
    summary: &'a str,
    facts: &'a [Fact],
    figures: &'a [Figure],
    tables: Vec<Section<'a>>,
}

#[derive(Serialize)]
struct Section<'a> {
    title: &'a str,
    text: &'a str,
    headings: &'a [String],
    rows: Vec<Vec<String>>,
}

impl Sheet {
    /// The page as HTML, one file.
    #[must_use]
    pub fn page(&self) -> String {
        let section = |(title, text, table): &'_ (String, String, Table)| -> (String, String, Table) {
            (title.clone(), text.clone(), table.clone())
        };
        let tables: Vec<_> = self.tables.iter().map(section).collect();
        let view = View {
            name: &self.name,
            kicker: &self.kicker,
            summary: &self.summary,
            facts: &self.facts,
            figures: &self.figures,
            tables: tables
                .iter()
                .map(|(title, text, table)| Section { title, text, headings: table.headings(), rows: table.filled() })
                .collect(),
        };
        fill("sheet.html", view)
    }
}
