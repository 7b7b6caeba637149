//! Tables for a terminal: columns as wide as they need to be, numbers to the right.

use std::fmt;

use super::format::{self, percent};
use super::results::Variant;

/// A table of texts under headings.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table {
    headings: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// A table with these headings.
    pub fn new<S: Into<String>>(headings: impl IntoIterator<Item = S>) -> Self {
        Self { headings: headings.into_iter().map(Into::into).collect(), rows: Vec::new() }
    }

    /// Adds a row; missing columns are empty.
    pub fn row<S: Into<String>>(&mut self, columns: impl IntoIterator<Item = S>) {
        self.rows.push(columns.into_iter().map(Into::into).collect());
    }

    pub fn headings(&self) -> &[String] {
        &self.headings
    }

    /// The rows, each as long as the headings.
    pub fn filled(&self) -> Vec<Vec<String>> {
        let mut rows = self.rows.clone();
        for row in &mut rows {
            row.resize(row.len().max(self.headings.len()), String::new());
        }
        rows
    }

    /// As Markdown.
    pub fn markdown(&self) -> String {
        let rule = vec!["---".to_owned(); self.headings.len()];
        let escaped =
            |text: &String| text.replace('|', "\\|").replace('<', "&lt;").replace('*', "\\*").replace('\n', " ");
        let line = |cells: &Vec<String>| format!("| {} |\n", cells.iter().map(escaped).collect::<Vec<_>>().join(" | "));
        [&self.headings, &rule].into_iter().chain(&self.filled()).map(line).collect()
    }

    /// A column is of numbers where every text in it begins as one.
    pub fn numeric(&self, column: usize) -> bool {
        let begins = |text: &String| text.starts_with(|c: char| c.is_ascii_digit() || "-−+.±∞".contains(c));
        let mut texts = self
            .rows
            .iter()
            .filter_map(|row| row.get(column))
            .filter(|text| !text.is_empty() && *text != format::DIVERGED);
        texts.clone().next().is_some() && texts.all(begins)
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let width = |text: &str| text.chars().count();
        let columns = self.rows.iter().map(Vec::len).chain([self.headings.len()]).max().unwrap_or(0);
        // its width, and whether it is of numbers
        let described: Vec<(usize, bool)> = (0..columns)
            .map(|column| {
                let all = self.rows.iter().chain([&self.headings]);
                let widest = all.filter_map(|row| row.get(column)).map(|text| width(text)).max();
                (widest.unwrap_or(0), self.numeric(column))
            })
            .collect();
        let rule: Vec<String> = described.iter().map(|&(width, _)| "─".repeat(width)).collect();
        for row in [&self.headings, &rule].into_iter().chain(&self.rows) {
            let mut line = String::from(" ");
            for (column, &(wide, numeric)) in described.iter().enumerate() {
                let cell = row.get(column).map_or("", String::as_str);
                let gap = " ".repeat(wide - width(cell));
                let (before, after) = if numeric { (gap.as_str(), "") } else { ("", gap.as_str()) };
                for part in [" ", before, cell, after, " "] {
                    line.push_str(part);
                }
            }
            writeln!(f, "{}", line.trim_end())?;
        }
        Ok(())
    }
}

/// The variants beside each other: error, cost, size.
pub fn variants_table(variants: &[Variant]) -> Table {
    let mut table = Table::new([
        "#",
        "number",
        "core",
        "observer",
        "rate",
        "shaft torque rms",
        "max",
        "load speed rms",
        "max",
        "load torque rms",
        "instructions med",
        "max",
        "cycles, bound",
        "flash",
        "RAM",
        "stack",
        "bit exact",
    ]);
    for (index, v) in variants.iter().enumerate() {
        table.row([
            (index + 1).to_string(),
            v.number.clone(),
            v.core.clone(),
            v.observer.clone(),
            format::rate(v.rate_hz),
            percent(v.shaft_torque.rms),
            percent(v.shaft_torque.max),
            percent(v.load_speed.rms),
            percent(v.load_speed.max),
            percent(v.load_torque.rms),
            v.instructions.median.to_string(),
            v.instructions.max.to_string(),
            format::interval(v.cycles),
            v.flash_bytes.to_string(),
            v.ram_bytes.to_string(),
            v.stack_bytes.to_string(),
            if v.bit_exact { "yes" } else { "NO" }.to_owned(),
        ]);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::Table;

    #[test]
    fn numbers_stand_to_the_right() {
        let mut table = Table::new(["name", "value"]);
        table.row(["a", "1.5"]);
        table.row(["longer", "120"]);
        table.row(["short row"]);
        let lines: Vec<String> = table.to_string().lines().map(str::to_owned).collect();
        assert_eq!(
            lines,
            ["  name       value", "  ─────────  ─────", "  a            1.5", "  longer       120", "  short row"]
        );
    }
}
