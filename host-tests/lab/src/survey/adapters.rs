//! The adapters' faults, from the document that a test writes and checks.

use std::fs;
use std::io;

use driveline_qemu::clone::workspace;
use driveline_report::Table;

/// The table of the clone's `doc/adapters.md`: every fault of every adapter, and what the drive does.
///
/// # Errors
/// No clone, or none with the document.
pub fn adapters() -> io::Result<Table> {
    let document = fs::read_to_string(workspace().map_err(io::Error::other)?.join("doc/adapters.md"))?;
    let cells = |line: &str| -> Vec<String> {
        line.trim().trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect()
    };
    let mut lines = document.lines().filter(|line| line.starts_with('|'));
    let mut table = Table::new(lines.next().map(cells).unwrap_or_default());
    // The rule below the headings.
    for line in lines.skip(1) {
        table.row(cells(line));
    }
    Ok(table)
}
