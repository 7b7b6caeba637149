//! `budgets.toml`: what each variant may take of each core.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use driveline_firmware::board::BOARDS;
use driveline_firmware::variants::VARIANTS;
use serde::Deserialize;
use toml::Spanned;

use crate::measure::BENCHES;

/// Upper limits; a figure that is not named has none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Budget {
    /// Instructions a tick.
    #[serde(default)]
    pub instructions: Instructions,
    /// Flash of the control loop's image, bytes.
    pub flash: Option<u64>,
    /// RAM of the control loop's image, the drive's state included and the stack not, bytes.
    pub ram: Option<u64>,
    /// Stack of a tick, bytes.
    pub stack: Option<u64>,
}

/// Upper limits of instructions a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Instructions {
    /// Of the cheapest tick.
    pub min: Option<u64>,
    /// Of the middle one.
    pub median: Option<u64>,
    /// Of the dearest.
    pub max: Option<u64>,
}

/// The budgets by variant and core.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Budgets(BTreeMap<(String, String), Budget>);

/// Why budgets could not be read.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
pub enum BudgetError {
    /// The file.
    #[error("{path}: {error}")]
    File {
        /// Its path.
        path: String,
        /// What went wrong.
        error: String,
    },
    /// A line that is not TOML, or a key that is no figure.
    #[error("budgets, line {line}, {key}: {message}")]
    Line {
        /// The line, from one.
        line: usize,
        /// The key there, or the line's text where it has none.
        key: String,
        /// What was expected.
        message: String,
    },
}

type Tables = BTreeMap<Spanned<String>, BTreeMap<Spanned<String>, Budget>>;

impl Budgets {
    /// Reads a file.
    pub fn read(path: &Path) -> Result<Self, BudgetError> {
        let text = fs::read_to_string(path)
            .map_err(|error| BudgetError::File { path: path.display().to_string(), error: error.to_string() })?;
        Budgets::parse(&text)
    }

    /// Reads text. Every variant must be one that the firmware has, every core one that a board has.
    pub fn parse(text: &str) -> Result<Self, BudgetError> {
        let tables: Tables = toml::from_str(text).map_err(|error| {
            let at = error.span().map_or(0, |span| span.start);
            let written = line_at(text, at).1;
            let key = written.split('=').next().unwrap_or(written).trim();
            BudgetError::Line { line: line_at(text, at).0, key: key.into(), message: error.message().into() }
        })?;
        let unknown = |key: &Spanned<String>, what: &str, names: Vec<&str>| BudgetError::Line {
            line: line_at(text, key.span().start).0,
            key: key.get_ref().clone(),
            message: format!("no such {what}, expected one of {}", names.join(", ")),
        };
        let mut budgets = BTreeMap::new();
        for (variant, cores) in tables {
            let name = variant.get_ref().as_str();
            if !VARIANTS.contains(&name) && !BENCHES.contains(&name) {
                return Err(unknown(&variant, "variant", [VARIANTS, BENCHES].concat()));
            }
            for (core, budget) in cores {
                if !BOARDS.iter().any(|board| board.core == core.get_ref()) {
                    return Err(unknown(&core, "core", BOARDS.iter().map(|board| board.core).collect()));
                }
                budgets.insert((variant.get_ref().clone(), core.into_inner()), budget);
            }
        }
        Ok(Budgets(budgets))
    }

    /// The budget of a variant on a core.
    pub fn of(&self, variant: &str, core: &str) -> Option<&Budget> {
        self.0.get(&(variant.into(), core.into()))
    }
}

/// The number, from one, and the text of the line with the byte at `at`.
fn line_at(text: &str, at: usize) -> (usize, &str) {
    let mut start = 0;
    let mut last = (1, "");
    for (index, line) in text.split_inclusive('\n').enumerate() {
        last = (index + 1, line.trim_end());
        start += line.len();
        if at < start {
            break;
        }
    }
    last
}

#[cfg(test)]
mod tests {
    use super::{BudgetError, Budgets};

    const VARIANT: &str = "empty/f32/none/10000";

    fn fails(text: &str) -> (usize, String, String) {
        match Budgets::parse(text) {
            Err(BudgetError::Line { line, key, message }) => (line, key, message),
            other => panic!("expected an error with a line, got {other:?}"),
        }
    }

    #[test]
    fn figures_are_read_and_may_be_left_out() {
        let text = format!("[\"{VARIANT}\"]\nm4f = {{ instructions = {{ max = 12 }}, flash = 900 }}\n");
        let budgets = Budgets::parse(&text).unwrap();
        let budget = budgets.of(VARIANT, "m4f").unwrap();
        assert_eq!((budget.instructions.max, budget.instructions.min), (Some(12), None));
        assert_eq!((budget.flash, budget.ram), (Some(900), None));
        assert_eq!(budgets.of(VARIANT, "m3"), None);
    }

    #[test]
    fn an_error_names_its_line_and_key() {
        let (line, key, message) = fails(&format!("# budgets\n[\"{VARIANT}\".m4f]\nflash = 900\nramm = 1\n"));
        assert_eq!((line, key.as_str()), (4, "ramm"));
        assert!(message.contains("expected one of"), "{message}");
        let (line, key, _) = fails(&format!("[\"{VARIANT}\".m4f]\n\nflash = -5\n"));
        assert_eq!((line, key.as_str()), (3, "flash"));
        let (line, key, _) = fails(&format!("[\"{VARIANT}\".m4f]\nflash = \"much\"\n"));
        assert_eq!((line, key.as_str()), (2, "flash"));
    }

    #[test]
    fn a_variant_or_a_core_that_is_not_there_is_an_error() {
        let (line, key, message) = fails("\n[\"hoist/f32\".m4f]\nflash = 1\n");
        assert_eq!((line, key.as_str()), (2, "hoist/f32"));
        assert!(message.contains(VARIANT), "{message}");
        let (line, key, message) = fails(&format!("[\"{VARIANT}\"]\nm5 = {{ flash = 1 }}\n"));
        assert_eq!((line, key.as_str(), message.as_str()), (2, "m5", "no such core, expected one of m4f, m3"));
    }
}
