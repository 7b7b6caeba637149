//! The adapters' faults, from the document that a test writes and checks.

use driveline_report::Table;

/// The document.
const DOCUMENT: &str = include_str!("../../../../doc/adapters.md");

/// The table of the document: every fault of every adapter, and what the drive does.
pub fn adapters() -> Table {
    let cells = |line: &str| -> Vec<String> {
        line.trim().trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect()
    };
    let mut lines = DOCUMENT.lines().filter(|line| line.starts_with('|'));
    let mut table = Table::new(lines.next().map(cells).unwrap_or_default());
    // The rule below the headings.
    for line in lines.skip(1) {
        table.row(cells(line));
    }
    table
}
