//! Failures of a command, and their output.

use std::io::IsTerminal;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

use serde_json::json;

use crate::machine_file::{Diagnostic, printable};

/// Why a command gave no result.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// A machine file with a fault: exit code 2.
    #[error(transparent)]
    Machine(#[from] Diagnostic),
    /// A wrong argument: exit code 2.
    #[error("{0}")]
    Usage(String),
    /// The command ran and did not succeed: exit code 1.
    #[error("{0}")]
    Failed(String),
}

impl Failure {
    /// A wrong argument, as a sentence.
    pub fn usage(sentence: impl Into<String>) -> Self {
        Self::Usage(sentence.into())
    }

    /// The failure, as a sentence.
    pub fn failed(sentence: impl Into<String>) -> Self {
        Self::Failed(sentence.into())
    }

    /// The exit code.
    pub const fn code(&self) -> u8 {
        match self {
            Self::Machine(_) | Self::Usage(_) => 2,
            Self::Failed(_) => 1,
        }
    }

    /// Prints it on standard error, as a sentence or as JSON, and returns the exit code.
    pub fn report(&self, as_json: bool) -> ExitCode {
        let say = |sentence: &str| eprintln!("{}", labelled(&format!("error: {sentence}")));
        match self {
            _ if as_json => {
                let mut value = json!({ "error": self.to_string() });
                if let Self::Machine(diagnostic) = self {
                    value["at"] = json!(diagnostic);
                }
                eprintln!("{value}");
            }
            Self::Machine(diagnostic) => say(&visible(&diagnostic.explained())),
            Self::Usage(sentence) => say(&format!("{}; see `--help`", visible(sentence))),
            Self::Failed(sentence) => say(&visible(sentence)),
        }
        ExitCode::from(self.code())
    }
}

/// Whether labels of errors are colored.
static COLORED: AtomicBool = AtomicBool::new(false);

/// Colors the labels of errors, or not; by default on a terminal that has not been told otherwise.
pub(super) fn color(wanted: Option<bool>) {
    let is_refused = || std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
    let on_terminal = || std::io::stderr().is_terminal() && !is_refused();
    COLORED.store(wanted.unwrap_or_else(on_terminal), Ordering::Relaxed);
}

/// A message with its label in red where it is colored.
pub(super) fn labelled(text: &str) -> String {
    match text.strip_prefix("error:") {
        Some(rest) if COLORED.load(Ordering::Relaxed) => format!("\x1b[1;31merror:\x1b[0m{rest}"),
        _ => text.to_owned(),
    }
}

/// A text that a name of a file or a word of the user's may be part of, fit for a terminal.
pub(super) fn visible(text: &str) -> String {
    text.lines().map(|line| printable(line, usize::MAX)).collect::<Vec<_>>().join("\n")
}
