//! Shards of a campaign, and their results in one.

use std::collections::BTreeMap;
use std::path::Path;

use super::figure::Outcome;
use super::record::{Settings, read};

/// One of several equal parts of a campaign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Which, from 1.
    pub which: u64,
    /// Of how many.
    pub of: u64,
}

impl Shard {
    /// Reads `K/N`.
    pub fn parse(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(k, n)| Some((k.parse().ok()?, n.parse().ok()?)));
        numbers
            .filter(|&(which, of)| 1 <= which && which <= of)
            .map(|(which, of)| Self { which, of })
            .ok_or_else(|| format!("shard `{text}`: expected K/N with K from 1 to N, such as 2/8"))
    }

    /// Whether a draw belongs to it.
    pub const fn has(self, draw: u64) -> bool {
        draw % self.of == self.which - 1
    }
}

/// The results of several files in one.
///
/// # Errors
/// A sentence: a file that cannot be read, of another campaign, with other figures for the same draw; draws that are
/// missing.
pub fn merge(paths: &[impl AsRef<Path>]) -> Result<(Settings, BTreeMap<u64, Outcome>), String> {
    let mut merged: Option<(Settings, BTreeMap<u64, Outcome>)> = None;
    for path in paths {
        let name = path.as_ref().display();
        let (settings, outcomes) = read(path.as_ref())?;
        let Some((first, all)) = &mut merged else {
            merged = Some((settings, outcomes));
            continue;
        };
        if *first != settings {
            return Err(format!("{name} is of another campaign than the files before it"));
        }
        for (number, outcome) in outcomes {
            if all.insert(number, outcome).is_some_and(|other| !other.is_same(&outcome)) {
                return Err(format!("{name}: draw {number} has other figures than in a file before it"));
            }
        }
    }
    let (settings, outcomes) = merged.ok_or("no file to merge")?;
    let missing = settings.draws - outcomes.len() as u64;
    if let Some(first) = (0..settings.draws).find(|number| !outcomes.contains_key(number)) {
        let names: Vec<String> = paths.iter().map(|path| path.as_ref().display().to_string()).collect();
        let names = names.join(", ");
        let sentence = format!("{names}: {missing} of {} draws are missing, draw {first} first", settings.draws);
        return Err(format!("{sentence}; run their shards to the end, and merge all of them"));
    }
    Ok((settings, outcomes))
}
