//! A step of the check and what it finds.

use std::io::Write;
use std::sync::{Mutex, PoisonError};

use serde::Serialize;

/// Result of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Count {
    /// Checks that passed: tests, images, figures, or one for the whole step.
    pub passed: u64,
    /// Checks that failed.
    pub failed: u64,
    /// Tests that could not be run, as what they need is not there; none of them is among the passed ones.
    pub skipped: u64,
}

/// In a line of a test that is skipped, before its name and the reason.
pub(super) const SKIPPED: &str = "skipped: ";

/// Says that the present test is skipped, and why. The line goes past the capture of the test's runner, which calls the
/// test passed, so that the check counts it.
pub fn skip(reason: impl std::fmt::Display) {
    let thread = std::thread::current();
    let line = format!("\n{SKIPPED}{}: {reason}\n", thread.name().unwrap_or("a test"));
    // one write, so that no line of another test is within it; a reader that has gone away needs none
    let _ = std::io::stdout().write_all(line.as_bytes());
}

/// A step of the check.
pub struct Step {
    pub name: &'static str,
    /// What it does, in a few words.
    pub content: &'static str,
    /// Command to type.
    pub repeat: &'static str,
    pub(super) run: fn(&Voice) -> Result<Count, Failed>,
}

/// A step's failure.
pub struct Failed {
    pub count: Count,
    pub message: String,
}

impl Failed {
    /// Of a step that is one check.
    pub fn whole(message: impl ToString) -> Self {
        Failed { count: Count { failed: 1, ..Count::default() }, message: message.to_string() }
    }
}

/// Where a step's own words go: standard output for a person, standard error where that is for JSON.
pub struct Voice {
    pub json: bool,
    figures: Mutex<Vec<String>>,
}

/// A line with these words has a figure after them, which is kept with the step's result: `measured: 40 seeds`.
const MEASURED: &str = "measured: ";

impl Voice {
    pub fn new(json: bool) -> Self {
        Voice { json, figures: Mutex::default() }
    }

    /// Takes the figures that have been said since.
    pub fn figures(&self) -> Vec<String> {
        std::mem::take(&mut self.figures.lock().unwrap_or_else(PoisonError::into_inner))
    }

    pub fn say(&self, line: &str) {
        if let Some((_, figure)) = line.split_once(MEASURED) {
            self.figures.lock().unwrap_or_else(PoisonError::into_inner).push(figure.trim().to_owned());
        }
        // a reader that has gone away is no reason to stop checking
        let _ = if self.json { writeln!(std::io::stderr(), "{line}") } else { writeln!(std::io::stdout(), "{line}") };
    }
}
