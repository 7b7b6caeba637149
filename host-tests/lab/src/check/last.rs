//! The page of the last long runs: a row a step, replaced when it has run.

use std::fs;
use std::io::{self, ErrorKind};
use std::path::Path;

use super::{Done, LONG, Step};
use crate::stamp::Stamp;

#[derive(Debug)]
pub struct Page {
    /// By the name of the step, in backticks, as the first cell has it.
    rows: Vec<(String, String)>,
    stamp: Stamp,
}

const HEAD: &str = "# Long runs

The last result of each long run. `cargo lab check --long --markdown doc/makers/long-runs.md` has written this page; with
`--only STEP` it replaces one row. [Checks](checks.md) has the steps. A `+` after the commit: the tree had changes.

| step | content | date | commit | passed | failed | minutes | figures |
|---|---|---|---|---|---|---|---|
";

impl Page {
    /// Reads it; it is empty where it is not there.
    pub fn read(path: &Path) -> io::Result<Self> {
        let text = match fs::read_to_string(path) {
            Err(error) if error.kind() != ErrorKind::NotFound => return Err(error),
            text => text.unwrap_or_default(),
        };
        let row = |line: &str| Some((line.strip_prefix("| ")?.split_once(" |")?.0.to_owned(), line.to_owned()));
        let rows = text.lines().filter(|line| line.starts_with("| `")).filter_map(row).collect();
        Ok(Page { rows, stamp: Stamp::now() })
    }

    /// Puts a step's result into its row; the text of the page.
    pub fn with(&mut self, step: &Step, done: &Done) -> String {
        let name = format!("`{}`", step.name);
        let (content, Stamp { date, commit }) = (step.content, &self.stamp);
        let (passed, failed, minutes) = (done.count.passed, done.count.failed, done.took.seconds / 60.0);
        let figures = done.figures.join("; ").replace('|', "/");
        let row =
            format!("| {name} | {content} | {date} | {commit} | {passed} | {failed} | {minutes:.1} | {figures} |");
        self.rows.retain(|(other, _)| *other != name);
        self.rows.push((name, row));
        // in the order of the steps; what is a step no more is dropped
        let row = |step: &Step| self.rows.iter().find(|(name, _)| name.trim_matches('`') == step.name);
        let rows: String = LONG.iter().filter_map(row).map(|(_, row)| format!("{row}\n")).collect();
        format!("{HEAD}{rows}")
    }
}
