//! The tables of the page in Markdown, for the book.

use std::fmt::Write;

use driveline_report::Fact;

use super::section::Section;

/// A page of the book.
pub(super) fn page(summary: &str, facts: &[Fact], sections: &[Section]) -> String {
    let mut text = format!("# Results\n\n{summary}\n\n");
    text.push_str(
        "`cargo lab report --markdown doc/makers/results.md` has written this page. \
         [Limits](../limits.md) has the limits of the figures.\n\n",
    );
    let headings = ["fact".to_owned(), "value".to_owned()];
    rows(&mut text, &headings, facts.iter().map(|fact| vec![fact.name.clone(), fact.value.clone()]));
    for section in sections {
        section.markdown(&mut text);
    }
    text.truncate(text.trim_end().len());
    text.push('\n');
    text
}

impl Section {
    fn markdown(&self, text: &mut String) {
        paragraph(text, "## ", &self.title);
        paragraph(text, "", &self.text);
        for failure in &self.failures {
            paragraph(text, "**Failed:** ", failure);
        }
        for (title, said, table) in &self.tables {
            paragraph(text, "### ", title);
            paragraph(text, "", said);
            rows(text, table.headings(), table.filled().into_iter());
        }
    }
}

/// A paragraph, unless there is nothing to say.
fn paragraph(text: &mut String, mark: &str, said: &str) {
    if !said.is_empty() {
        let _ = writeln!(text, "{mark}{}\n", escaped(said));
    }
}

/// A table.
fn rows(text: &mut String, headings: &[String], rows: impl Iterator<Item = Vec<String>>) {
    let mut line = |cells: &[String]| {
        let cells: Vec<String> = cells.iter().map(|cell| escaped(cell)).collect();
        let _ = writeln!(text, "| {} |", cells.join(" | "));
    };
    line(headings);
    line(&vec!["---".to_owned(); headings.len()]);
    for row in rows {
        line(&row);
    }
    text.push('\n');
}

/// What Markdown would take for something else.
fn escaped(text: &str) -> String {
    text.replace('|', "\\|").replace('<', "&lt;").replace('*', "\\*").replace('\n', " ")
}
