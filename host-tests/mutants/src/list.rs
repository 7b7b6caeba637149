//! The list of the mutants, by `cargo mutants --list`.

use std::collections::HashMap;
use std::path::Path;
use std::process::Command;

use serde::Deserialize;

/// What is on the path of a tick.
const TICK_PATH: [&str; 9] =
    ["observer", "drive", "governor", "fluctuation", "fault", "balancing", "axis", "number", "settings"];

#[derive(Clone, Debug, Deserialize)]
pub struct Mutant {
    #[serde(skip)]
    pub number: u32,
    /// The name without its place, which other commits move: with its rank among equals in the file.
    #[serde(skip)]
    pub key: String,
    /// File, line, column and change.
    pub name: String,
    pub file: String,
    pub span: Place,
    pub genre: String,
    pub replacement: String,
}

#[derive(Clone, Copy, Debug, Deserialize)]
pub struct Place {
    pub start: LineColumn,
}

#[derive(Clone, Copy, Debug, Deserialize)]
pub struct LineColumn {
    pub line: usize,
    pub column: usize,
}

impl Mutant {
    /// The part of the library.
    pub fn module(&self) -> &str {
        let path = self.file.trim_start_matches("src/");
        path.split(['/', '.']).next().unwrap_or(path)
    }
}

/// The mutants of the tick path in the clone at `root`, numbered from 1.
pub fn list(root: &Path) -> Vec<Mutant> {
    let mut command = Command::new("cargo");
    command.current_dir(root).args(["mutants", "--list", "--json", "--package", "driveline"]);
    for part in TICK_PATH {
        command.args(["--file", &format!("src/{part}.rs"), "--file", &format!("src/{part}/**/*.rs")]);
    }
    let output = command.output().expect("cargo");
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        panic!("`cargo mutants --list`, from `cargo install cargo-mutants --locked`: {said}");
    }
    let mut mutants: Vec<Mutant> = serde_json::from_slice(&output.stdout).expect("a list of mutants");
    let mut equals: HashMap<String, u32> = HashMap::new();
    for (index, mutant) in mutants.iter_mut().enumerate() {
        mutant.number = index as u32 + 1;
        let change = mutant.name.splitn(4, ':').nth(3).unwrap_or_default();
        let rank = equals.entry(format!("{}:{change}", mutant.file)).or_default();
        *rank += 1;
        mutant.key = format!("{}:{change} #{rank}", mutant.file);
    }
    mutants
}
