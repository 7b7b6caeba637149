//! `budgets.toml`: the figures of each variant, and the most that they may become.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use driveline_firmware::board::BOARDS;
use driveline_firmware::scenes::VARIANTS;
use serde::Deserialize;
use toml::Spanned;

use crate::measure::BENCHES;

/// Figures of a variant on a core; one that is not named has no limit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Budget {
    /// Median instructions of a tick, counted.
    pub median: Option<u64>,
    /// Instructions on the longest path of a tick.
    pub longest: Option<u64>,
    /// Whether the longest path is refused.
    #[serde(default)]
    pub unbounded: bool,
    /// Flash of the control loop's image, bytes.
    pub flash: Option<u64>,
    /// RAM of the control loop's image, the drive's state included and the stack not, bytes.
    pub ram: Option<u64>,
    /// Stack of a tick, the larger of the painted and the bound, bytes.
    pub stack: Option<u64>,
    /// What the project has promised, whatever the figures are.
    #[serde(default)]
    pub promised: Promised,
}

/// Bounds that the project has promised, as the figures of [`Budget`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Promised {
    median: Option<u64>,
    longest: Option<u64>,
    flash: Option<u64>,
    ram: Option<u64>,
    stack: Option<u64>,
}

/// The most that a figure may become: a tenth more, of the longest path a twentieth, as it is no sample. Stack grows by
/// two registers at least and state by a pair of words, which is more than a tenth of little.
pub fn most(name: &str, figure: u64) -> u64 {
    let (part, least) = match name {
        "longest" => (20, 1),
        "ram" | "stack" | "stack bound" => (10, 8),
        _ => (10, 1),
    };
    figure + figure.div_ceil(part).max(least)
}

impl Budget {
    /// The most that each figure may become, or what is promised where that is less.
    #[must_use]
    pub fn limits(&self) -> Self {
        let Self { promised, .. } = *self;
        let limit = |name, figure: Option<u64>, promised: Option<u64>| {
            figure.map(|figure| most(name, figure)).into_iter().chain(promised).min()
        };
        Self {
            median: limit("median", self.median, promised.median),
            longest: limit("longest", self.longest, promised.longest),
            flash: limit("flash", self.flash, promised.flash),
            ram: limit("ram", self.ram, promised.ram),
            stack: limit("stack", self.stack, promised.stack),
            ..*self
        }
    }
}

/// The budgets by variant and core.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Budgets {
    named: BTreeMap<(String, String), Budget>,
}

/// Why budgets could not be read.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
pub enum BudgetError {
    #[error("{path}: {error}")]
    File { path: String, error: String },
    /// A line that is not TOML, or a key that is no figure.
    #[error("budgets, line {line}, {key}: {message}")]
    Line {
        line: usize,
        /// The key there, or the line's text where it has none.
        key: String,
        /// The expected value.
        message: String,
    },
}

/// Figures by scene, by number, observer and rate, and by core.
type Tables = BTreeMap<String, BTreeMap<Spanned<String>, BTreeMap<Spanned<String>, Budget>>>;

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
            for (variant, figures) in variants {
                let name = format!("{scene}/{}", variant.get_ref());
                let names = [VARIANTS, BENCHES].concat();
                if !names.contains(&name.as_str()) {
                    return Err(unknown(&variant, "variant", &names));
                }
                for (core, budget) in figures {
                    if !cores.contains(&core.get_ref().as_str()) {
                        return Err(unknown(&core, "core", &cores));
                    }
                    budgets.named.insert((name.clone(), core.into_inner()), budget);
                }
            }
        }
        Ok(budgets)
    }

    /// The figures of a variant on a core.
    pub fn of(&self, variant: &str, core: &str) -> Option<Budget> {
        self.named.get(&(variant.into(), core.into())).copied()
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
    use super::{Budget, BudgetError, Budgets, most};

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
        let text = format!("[{SCENE}]\n\"{VARIANT}\".m4f = {{ median = 12, flash = 900 }}\n");
        let budgets = Budgets::parse(&text).unwrap();
        let budget = budgets.of("empty/f32/none/10000", "m4f").unwrap();
        assert_eq!(budget, Budget { median: Some(12), flash: Some(900), ..Budget::default() });
        assert_eq!(budgets.of("empty/f32/none/10000", "m3"), None);
    }

    /// A tenth, of the longest path a twentieth; eight bytes of RAM and stack at least; no more than is promised.
    #[test]
    fn a_limit_is_a_tenth_above_its_figure_or_what_is_promised() {
        let text = format!(
            "[{SCENE}]\n\"{VARIANT}\".m4f = {{ median = 55, longest = 155, flash = 905, ram = 48, stack = 100, \
             promised = {{ longest = 160, flash = 2000 }} }}\n"
        );
        let limits = Budgets::parse(&text).unwrap().of("empty/f32/none/10000", "m4f").unwrap().limits();
        assert_eq!((limits.median, limits.longest, limits.flash), (Some(61), Some(160), Some(996)));
        assert_eq!((limits.ram, limits.stack), (Some(56), Some(110)));
        assert_eq!([155, 3].map(|figure| most("longest", figure)), [163, 4]);
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
    fn a_variant_or_a_core_that_is_not_there_is_an_error() {
        let (line, key, message) = fails("\n[hoist]\n\"f32\".m4f = { flash = 1 }\n");
        assert_eq!((line, key.as_str()), (3, "f32"));
        assert!(message.contains("empty/f32/none/10000"), "{message}");
        let (line, key, message) = fails(&format!("[{SCENE}]\n\"{VARIANT}\".m5 = {{ flash = 1 }}\n"));
        assert_eq!((line, key.as_str(), message.as_str()), (2, "m5", "no such core, expected one of m4f, m3"));
    }
}
