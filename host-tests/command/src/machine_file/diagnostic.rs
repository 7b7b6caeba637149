//! Faults of a machine file: place, key, value found, value expected.

use std::fmt;
use std::ops::Range;

use serde::Serialize;

use super::source::Source;

/// A fault in a machine file. Its `Display` is one sentence; [`Diagnostic::explained`] adds the source line.
///
/// Boxed, so that a `Result` of it stays small.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(transparent)]
pub struct Diagnostic(Box<Fault>);

/// The fault and its place.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Fault {
    /// The file as the user named it.
    pub file: String,
    /// Line, from 1; 0 where the fault is the file as a whole.
    pub line: usize,
    /// Column in characters, from 1; 0 where the fault is the file as a whole.
    pub column: usize,
    /// The key as a path, as `element[2].inertia`; empty where the fault is the file itself.
    pub key: String,
    /// Value found.
    pub found: String,
    /// Value expected.
    pub expected: String,
    /// The source line with a caret below the place; empty where there is no text to show.
    #[serde(skip)]
    snippet: String,
}

impl std::ops::Deref for Diagnostic {
    type Target = Fault;

    fn deref(&self) -> &Fault {
        &self.0
    }
}

impl Diagnostic {
    /// A fault at a span of a text.
    pub fn at(
        source: Source<'_>,
        span: Range<usize>,
        key: impl Into<String>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Self {
        let position = source.position(span.start);
        Self(Box::new(Fault {
            file: source.name.to_owned(),
            line: position.line,
            column: position.column,
            key: key.into(),
            found: found.into(),
            expected: expected.into(),
            snippet: source.snippet(span),
        }))
    }

    /// A fault of the file as a whole, where no text can be shown.
    pub fn of_file(file: &str, found: impl Into<String>, expected: impl Into<String>) -> Self {
        Self(Box::new(Fault {
            file: file.to_owned(),
            line: 0,
            column: 0,
            key: String::new(),
            found: found.into(),
            expected: expected.into(),
            snippet: String::new(),
        }))
    }

    /// The sentence, and below it the source line with a caret.
    pub fn explained(&self) -> String {
        if self.snippet.is_empty() { self.to_string() } else { format!("{self}\n{}", self.snippet) }
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Fault { file, line, column, key, found, expected, .. } = &**self;
        match line {
            0 => write!(f, "{file}: ")?,
            _ => write!(f, "{file}:{line}:{column}: ")?,
        }
        if !key.is_empty() {
            write!(f, "`{key}`: ")?;
        }
        write!(f, "found {found}, expected {expected}")
    }
}

impl std::error::Error for Diagnostic {}
