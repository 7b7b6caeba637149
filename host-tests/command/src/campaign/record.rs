//! The file of a campaign: its settings, and a line for each draw that is done.
//!
//! A line is appended when its draw is done, so that a campaign that was killed goes on where it was. Numbers are
//! written so that they are read back to the bit, and each line ends with its check sum: a changed digit is refused. A
//! file of other settings is refused, and so is one of another version of the library or the plant: the nominal
//! machine's outcome stands among the settings.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs::{File, OpenOptions};
use std::io::{Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};

use driveline_qemu::children::Guard;
use tempfile::NamedTempFile;

use super::figure::{FIGURES, Figure, Outcome};
use crate::machine_file::factor::Tolerance;
use crate::telemetry::crc;

/// What a campaign is of.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The variant, as `hoist/f32/reduced/10000`.
    pub variant: String,
    /// Number of draws.
    pub draws: u64,
    /// Seed of the draws.
    pub seed: u64,
    pub tolerances: Vec<Tolerance>,
    /// The nominal machine's outcome.
    pub nominal: Outcome,
    /// What the loop of a machine file's drive lacks of the usual margins.
    pub lacks: Option<String>,
}

/// First line of a file.
const FIRST: &str = "# driveline campaign 2";

impl Settings {
    pub fn scene(&self) -> &str {
        self.variant.split('/').next().unwrap_or_default()
    }

    /// The lines that a file of this campaign begins with.
    fn text(&self) -> String {
        let mut text = format!("{FIRST}\n# variant {}\n# draws {}\n# seed {}\n", self.variant, self.draws, self.seed);
        for tolerance in &self.tolerances {
            // Writing to a `String` cannot fail.
            let _ = writeln!(text, "# tolerance {tolerance}");
        }
        let _ = writeln!(text, "# nominal{}", numbers(&self.nominal));
        if let Some(lacks) = &self.lacks {
            let _ = writeln!(text, "# lacks {lacks}");
        }
        let names: Vec<&str> = Figure::ALL.iter().map(|figure| figure.name()).collect();
        let _ = writeln!(text, "# columns: draw; {}; check sum", names.join("; "));
        let sum = crc(text.as_bytes());
        let _ = writeln!(text, "# check {sum:04x}");
        text
    }

    fn parse(text: &str) -> Option<Self> {
        let settings: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("# ")).collect();
        let one = |key: &str| settings.iter().find_map(|line| line.strip_prefix(key));
        let tolerances = settings.iter().filter_map(|line| line.strip_prefix("tolerance "));
        let tolerances: Result<Vec<Tolerance>, String> = tolerances.map(Tolerance::parse).collect();
        Some(Self {
            variant: one("variant ")?.to_owned(),
            draws: one("draws ")?.parse().ok()?,
            seed: one("seed ")?.parse().ok()?,
            tolerances: tolerances.ok()?,
            nominal: outcome(one("nominal ")?)?,
            lacks: one("lacks ").map(ToOwned::to_owned),
        })
    }

    /// Whether it is the other campaign with more draws.
    fn extends(&self, fewer: &Self) -> bool {
        fewer.draws < self.draws && Self { draws: self.draws, ..fewer.clone() } == *self
    }

    /// The file of a campaign with some draws done, by their numbers: the whole one where all are.
    pub fn file(&self, outcomes: &BTreeMap<u64, Outcome>) -> String {
        let lines = outcomes.iter().map(|(number, outcome)| line(*number, outcome));
        std::iter::once(self.text()).chain(lines).collect()
    }
}

fn numbers(outcome: &Outcome) -> String {
    // the shortest text that is read back to the bit
    outcome.0.iter().fold(String::new(), |text, number| text + " " + &number.to_string())
}

fn line(number: u64, outcome: &Outcome) -> String {
    let text = format!("{number}{}", numbers(outcome));
    format!("{text} {:04x}\n", crc(text.as_bytes()))
}

fn outcome(text: &str) -> Option<Outcome> {
    let numbers: Option<Vec<f64>> = text.split_whitespace().map(|number| number.parse().ok()).collect();
    let numbers: [f64; FIGURES] = numbers?.try_into().ok()?;
    Some(Outcome(numbers))
}

fn changed(name: &impl std::fmt::Display, line: usize, remedy: &str) -> String {
    format!("{name}, line {line}: found a line that was changed, expected one with its check sum; {remedy}")
}

/// The settings and the draws of a file's text, and how many bytes of it are whole lines.
fn parse(path: &Path, text: &str) -> Result<(Settings, BTreeMap<u64, Outcome>, usize), String> {
    let name = path.display();
    let no_campaign = || no_campaign(path);
    let settings = Settings::parse(text).ok_or_else(no_campaign)?;
    let begin = settings.text();
    // the settings are as this version writes them, with their check sum
    let lines =
        text.strip_prefix(&begin).ok_or_else(|| match begin.lines().zip(text.lines()).position(|(a, b)| a != b) {
            Some(at) => changed(&name, at + 1, "merge or go on with an unchanged copy"),
            None => no_campaign(),
        })?;
    let whole = lines.rfind('\n').map_or(0, |at| at + 1);
    let mut outcomes = BTreeMap::new();
    for (at, line) in lines[..whole].lines().enumerate() {
        let number = begin.lines().count() + at + 1;
        let entry = line.rsplit_once(' ').and_then(|(line, sum)| Some((line, u16::from_str_radix(sum, 16).ok()?)));
        let Some((line, _)) = entry.filter(|(line, sum)| crc(line.as_bytes()) == *sum) else {
            return Err(changed(&name, number, "delete the line to run its draw again"));
        };
        let entry = line.split_once(' ').and_then(|(number, rest)| Some((number.parse().ok()?, outcome(rest)?)));
        let line = number;
        let Some((number, outcome)) = entry.filter(|(number, _)| *number < settings.draws) else {
            return Err(format!(
                "{name}, line {line}: expected a draw below {} and {FIGURES} numbers; delete the line to run its draw \
                 again",
                settings.draws
            ));
        };
        if outcomes.insert(number, outcome).is_some_and(|other| !other.is_same(&outcome)) {
            return Err(format!(
                "{name}, line {line}: draw {number} stands there twice with other figures; delete both"
            ));
        }
    }
    Ok((settings, outcomes, begin.len() + whole))
}

/// Largest file: a million draws have a third of it.
const LARGEST: u64 = 1 << 30;

/// The text of a file, refused at its first bytes where it is none of a campaign: what has no end, too.
fn text(file: &File, path: &Path) -> Result<String, String> {
    let system = |error: std::io::Error| format!("{}: {error}", path.display());
    let (mut bytes, mut file) = (Vec::new(), file.take(LARGEST));
    file.by_ref().take(FIRST.len() as u64).read_to_end(&mut bytes).map_err(system)?;
    if !FIRST.as_bytes().starts_with(&bytes) {
        return Err(no_campaign(path));
    }
    file.read_to_end(&mut bytes).map_err(system)?;
    if file.limit() == 0 {
        return Err(format!("{}: more than 1 GiB, expected a file of a campaign of at most 1 GiB", path.display()));
    }
    String::from_utf8(bytes).map_err(|error| {
        let line = error.as_bytes()[..error.utf8_error().valid_up_to()].iter().filter(|byte| **byte == b'\n').count();
        changed(&path.display(), line + 1, "delete the line to run its draw again")
    })
}

fn no_campaign(path: &Path) -> String {
    format!(
        "{} is not a campaign file of this version: expected one that `campaign` has written, or a new name",
        path.display()
    )
}

/// Reads a file.
///
/// # Errors
/// A sentence: it cannot be read, is none, or was changed.
pub fn read(path: &Path) -> Result<(Settings, BTreeMap<u64, Outcome>), String> {
    let system = |error: std::io::Error| format!("{}: {error}", path.display());
    let text = text(&File::open(path).map_err(system)?, path)?;
    parse(path, &text).map(|(settings, outcomes, _)| (settings, outcomes))
}

/// A file of a campaign at work: no other process has it open.
#[derive(Debug)]
pub struct Record {
    path: PathBuf,
    file: File,
    /// The draws that are done.
    pub outcomes: BTreeMap<u64, Outcome>,
}

impl Record {
    /// Opens the file of a campaign, or begins it. One of fewer draws goes on to more.
    ///
    /// # Errors
    /// A sentence: a file of other settings, one that another process writes, or what the system says.
    pub fn open(path: &Path, settings: &Settings) -> Result<Self, String> {
        let name = path.display();
        let system = |error: std::io::Error| format!("{name}: {error}");
        if path.metadata().is_ok_and(|there| !there.is_file()) {
            return Err(format!(
                "{name} is not a file, which a campaign could go on from; name another with --results"
            ));
        }
        let mut file =
            OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path).map_err(system)?;
        file.try_lock().map_err(|error| format!("{name} is in use by another campaign: {error}"))?;
        let text = text(&file, path)?;
        let begin = settings.text();
        if Settings::parse(&text).is_some_and(|fewer| settings.extends(&fewer)) {
            // beside it first: a kill loses nothing
            let (_, outcomes, _) = parse(path, &text)?;
            // where a link leads, with the rights of what stands there
            let path = path.canonicalize().map_err(system)?;
            let permissions = file.metadata().map_err(system)?.permissions();
            let folder = path.parent().unwrap_or(Path::new("/"));
            let make = || tempfile::Builder::new().permissions(permissions).tempfile_in(folder);
            let (_guard, mut beside) = Guard::around(make, NamedTempFile::path).map_err(system)?;
            beside.write_all(settings.file(&outcomes).as_bytes()).map_err(system)?;
            beside.persist(&path).map_err(|error| system(error.error))?;
            drop(file);
            return Self::open(&path, settings);
        }
        let outcomes = if begin.starts_with(&text) {
            // killed before the first draw, at the latest
            file.set_len(0).map_err(system)?;
            file.seek(SeekFrom::Start(0)).map_err(system)?;
            file.write_all(begin.as_bytes()).map_err(system)?;
            BTreeMap::new()
        } else {
            let (theirs, outcomes, whole) = parse(path, &text)?;
            // the nominal run depends on the drive and the machine alone
            if theirs.variant == settings.variant && !theirs.nominal.is_same(&settings.nominal) {
                return Err(format!(
                    "{name} was written before the machine, by its file or by this program, changed: its nominal run \
                     has other figures; name another file with --results"
                ));
            }
            if let Some((ours, theirs)) = begin.lines().zip(text.lines()).find(|(ours, theirs)| ours != theirs) {
                let differ = |line: &str| line.trim_start_matches("# ").to_owned();
                return Err(format!(
                    "{name} is of another campaign: it has `{}`, this one `{}`; name another file with --results",
                    differ(theirs),
                    differ(ours)
                ));
            }
            file.set_len(whole as u64).map_err(system)?;
            file.seek(SeekFrom::End(0)).map_err(system)?;
            outcomes
        };
        Ok(Self { path: path.to_owned(), file, outcomes })
    }

    /// Adds a draw.
    pub fn add(&mut self, number: u64, outcome: Outcome) -> Result<(), String> {
        let written = self.file.write_all(line(number, &outcome).as_bytes());
        written.map_err(|error| format!("{}: {error}", self.path.display()))?;
        self.outcomes.insert(number, outcome);
        Ok(())
    }
}
