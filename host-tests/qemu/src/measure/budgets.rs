//! `budgets.toml`: the most that each variant may take of each core.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use driveline_firmware::board::BOARDS;
use driveline_firmware::scenes::VARIANTS;
use serde::Deserialize;
use toml::Spanned;

use crate::measure::BENCHES;

/// Upper limits; a figure that is not named has none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Budget {
    /// Instructions of a tick, counted.
    pub instructions: Option<u64>,
    /// Instructions on the longest path of a tick.
    pub longest: Option<u64>,
    /// Whether the longest path is refused: there is no limit then, not even that of `default`.
    #[serde(default)]
    pub unbounded: bool,
    /// Flash of the control loop's image, bytes.
    pub flash: Option<u64>,
    /// RAM of the control loop's image, the drive's state included and the stack not, bytes.
    pub ram: Option<u64>,
    /// Stack of a tick, painted and bounded alike, bytes.
    pub stack: Option<u64>,
}

impl Budget {
    /// These limits, and those of `default` for the figures that are not named.
    fn or(self, default: Budget) -> Self {
        Budget {
            instructions: self.instructions.or(default.instructions),
            longest: self.longest.or(default.longest.filter(|_| !self.unbounded)),
            unbounded: self.unbounded,
            flash: self.flash.or(default.flash),
            ram: self.ram.or(default.ram),
            stack: self.stack.or(default.stack),
        }
    }
}

/// The budgets by variant and core, and the defaults by number and core.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Budgets {
    named: BTreeMap<(String, String), Budget>,
    defaults: BTreeMap<(String, String), Budget>,
}

/// Why budgets could not be read.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
pub enum BudgetError {
    /// The file.
    #[error("{path}: {error}")]
    File {
        /// Its path.
        path: String,
        /// The error.
        error: String,
    },
    /// A line that is not TOML, or a key that is no figure.
    #[error("budgets, line {line}, {key}: {message}")]
    Line {
        /// The line, from one.
        line: usize,
        /// The key there, or the line's text where it has none.
        key: String,
        /// The expected value.
        message: String,
    },
}

/// Limits by scene, by number, observer and rate, and by core; `default` stands in place of a scene.
type Tables = BTreeMap<String, BTreeMap<Spanned<String>, BTreeMap<Spanned<String>, Budget>>>;

/// The table of the defaults, by number.
const DEFAULT: &str = "default";
const NUMBERS: [&str; 2] = ["f32", "fixed"];

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
            let (line, written) = line_at(text, at);
            let key = written.split('=').next().unwrap_or(written).trim();
            BudgetError::Line { line, key: key.into(), message: error.message().into() }
        })?;
        let unknown = |key: &Spanned<String>, what: &str, names: &[&str]| BudgetError::Line {
            line: line_at(text, key.span().start).0,
            key: key.get_ref().clone(),
            message: format!("no such {what}, expected one of {}", names.join(", ")),
        };
        let cores: Vec<&str> = BOARDS.iter().map(|board| board.core).collect();
        let mut budgets = Budgets::default();
        for (scene, variants) in tables {
            for (variant, limits) in variants {
                let name =
                    if scene == DEFAULT { variant.get_ref().clone() } else { format!("{scene}/{}", variant.get_ref()) };
                let names = if scene == DEFAULT { NUMBERS.to_vec() } else { [VARIANTS, BENCHES].concat() };
                if !names.contains(&name.as_str()) {
                    return Err(unknown(&variant, if scene == DEFAULT { "number" } else { "variant" }, &names));
                }
                for (core, budget) in limits {
                    if !cores.contains(&core.get_ref().as_str()) {
                        return Err(unknown(&core, "core", &cores));
                    }
                    let all = if scene == DEFAULT { &mut budgets.defaults } else { &mut budgets.named };
                    all.insert((name.clone(), core.into_inner()), budget);
                }
            }
        }
        Ok(budgets)
    }

    /// The budget of a variant on a core: its own limits, the default for the others; `None` where it has neither.
    pub fn of(&self, variant: &str, core: &str) -> Option<Budget> {
        let number = variant.split('/').nth(1).unwrap_or_default();
        let default = self.defaults.get(&(number.into(), core.into()));
        let named = self.named.get(&(variant.into(), core.into()));
        match (named, default) {
            (None, None) => None,
            (named, default) => Some(named.copied().unwrap_or_default().or(default.copied().unwrap_or_default())),
        }
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
    use super::{Budget, BudgetError, Budgets};

    const SCENE: &str = "empty";
    const VARIANT: &str = "f32/none/10000";

    fn fails(text: &str) -> (usize, String, String) {
        match Budgets::parse(text) {
            Err(BudgetError::Line { line, key, message }) => (line, key, message),
            other => panic!("expected an error with a line, got {other:?}"),
        }
    }

    #[test]
    fn figures_are_read_and_may_be_left_out() {
        let text = format!("[{SCENE}]\n\"{VARIANT}\".m4f = {{ instructions = 12, flash = 900 }}\n");
        let budgets = Budgets::parse(&text).unwrap();
        let budget = budgets.of("empty/f32/none/10000", "m4f").unwrap();
        assert_eq!(budget, Budget { instructions: Some(12), flash: Some(900), ..Budget::default() });
        assert_eq!(budgets.of("empty/f32/none/10000", "m3"), None);
    }

    #[test]
    fn a_figure_that_is_not_named_has_the_default_of_its_number_and_core() {
        let text = format!(
            "[default]\nf32.m4f = {{ flash = 6000, stack = 64 }}\n[{SCENE}]\n\"{VARIANT}\".m4f = {{ flash = 900 }}\n"
        );
        let budgets = Budgets::parse(&text).unwrap();
        let expected = |flash| Some(Budget { flash: Some(flash), stack: Some(64), ..Budget::default() });
        assert_eq!(budgets.of("empty/f32/none/10000", "m4f"), expected(900));
        assert_eq!(budgets.of("hoist/f32/reduced/10000", "m4f"), expected(6000));
        assert_eq!(budgets.of("hoist/fixed/reduced/10000", "m4f"), None);
    }

    #[test]
    fn a_variant_without_a_bound_has_no_limit_of_the_longest_path() {
        let text =
            format!("[default]\nf32.m4f = {{ longest = 60 }}\n[{SCENE}]\n\"{VARIANT}\".m4f = {{ unbounded = true }}\n");
        let budgets = Budgets::parse(&text).unwrap();
        assert_eq!(budgets.of("empty/f32/none/10000", "m4f").unwrap().longest, None);
        assert_eq!(budgets.of("hoist/f32/reduced/10000", "m4f").unwrap().longest, Some(60));
    }

    #[test]
    fn an_error_names_its_line_and_key() {
        let (line, key, message) = fails(&format!("# budgets\n[{SCENE}.\"{VARIANT}\".m4f]\nflash = 900\nramm = 1\n"));
        assert_eq!((line, key.as_str()), (4, "ramm"));
        assert!(message.contains("expected one of"), "{message}");
        let (line, key, _) = fails(&format!("[{SCENE}.\"{VARIANT}\".m4f]\n\nflash = -5\n"));
        assert_eq!((line, key.as_str()), (3, "flash"));
        let (line, key, _) = fails(&format!("[{SCENE}]\n\"{VARIANT}\".m4f = {{ flash = \"much\" }}\n"));
        assert_eq!((line, key.as_str()), (2, "\"f32/none/10000\".m4f"));
    }

    #[test]
    fn a_variant_a_number_or_a_core_that_is_not_there_is_an_error() {
        let (line, key, message) = fails("\n[hoist]\n\"f32\".m4f = { flash = 1 }\n");
        assert_eq!((line, key.as_str()), (3, "f32"));
        assert!(message.contains("empty/f32/none/10000"), "{message}");
        let (line, key, message) = fails("[default]\nf64.m4f = { flash = 1 }\n");
        assert_eq!((line, key.as_str(), message.as_str()), (2, "f64", "no such number, expected one of f32, fixed"));
        let (line, key, message) = fails(&format!("[{SCENE}]\n\"{VARIANT}\".m5 = {{ flash = 1 }}\n"));
        assert_eq!((line, key.as_str(), message.as_str()), (2, "m5", "no such core, expected one of m4f, m3"));
    }
}
