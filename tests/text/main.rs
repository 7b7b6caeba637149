//! The repository's text: retired words stay retired, and no line is longer than 120 columns.
//!
//! `doc/glossary.md` has the words. A retired name in backticks, `folder::name`, is no public item in that folder of
//! `src`; a retired phrase in quotation marks is in no comment, message or page.

mod citations;

use std::fs;
use std::path::{Path, PathBuf};

/// Columns of a line at most, as `rustfmt.toml` has it.
const COLUMNS: usize = 120;

/// Names and phrases that were given up.
#[derive(Debug, Default)]
struct Retired {
    /// A folder or file of `src`, empty for any, and a name.
    names: Vec<(String, String)>,
    phrases: Vec<String>,
}

impl Retired {
    /// From the glossary's table: the last column of each row.
    fn of(glossary: &str) -> Self {
        let mut retired = Self::default();
        for row in glossary.lines().filter(|line| line.starts_with("| ")) {
            let last = row.trim_end_matches('|').rsplit('|').next().unwrap_or_default();
            for item in last.split(", ").map(str::trim) {
                if let Some(name) = item.strip_prefix('`').and_then(|rest| rest.strip_suffix('`')) {
                    let (folder, name) = name.split_once("::").unwrap_or(("", name));
                    retired.names.push((folder.to_owned(), name.to_owned()));
                } else if let Some(phrase) = item.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')) {
                    retired.phrases.push(phrase.to_lowercase());
                }
            }
        }
        retired
    }

    /// What is wrong with a file, a sentence each.
    fn faults(&self, path: &str, text: &str) -> Vec<String> {
        let mut faults = Vec::new();
        for (at, line) in text.lines().enumerate() {
            for (folder, name) in &self.names {
                if within(path, folder) && public_item(line) == Some(name) {
                    faults.push(format!("{path}:{}: `{name}` is retired, see doc/glossary.md", at + 1));
                }
            }
        }
        let text = prose(path, text);
        for phrase in self.phrases.iter().filter(|phrase| has_phrase(&text, phrase)) {
            faults.push(format!("{path}: \"{phrase}\" is retired, see doc/glossary.md"));
        }
        faults
    }
}

/// Whether a file belongs to a folder of the library, `src/governor.rs` and `src/governor/` alike.
fn within(path: &str, folder: &str) -> bool {
    let Some(path) = path.strip_prefix("src/") else { return false };
    folder.is_empty() || path.strip_prefix(folder).is_some_and(|rest| rest.starts_with(['/', '.']))
}

/// The name of the public item that a line declares: a type, function, constant, module or field.
fn public_item(line: &str) -> Option<&str> {
    let mut words = line.trim_start().strip_prefix("pub ")?.split_whitespace();
    let kinds = ["struct", "enum", "trait", "type", "fn", "mod", "const", "static", "async"];
    let word = words.find(|word| !kinds.contains(word))?;
    Some(word.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or(word))
}

/// The text for people: comments and string literals of a source file, all of any other; in lower case, one space
/// between words.
fn prose(path: &str, text: &str) -> String {
    let mut out = String::new();
    let mut open = false;
    for line in text.lines() {
        let line = line.trim();
        if !path.ends_with(".rs") {
            out.push_str(line);
        } else if let Some(comment) = line.strip_prefix("//") {
            out.push_str(comment.trim_start_matches(['/', '!']).trim());
        } else {
            // every other piece between quotation marks; a literal whose line ends in a backslash goes on
            let pieces: Vec<&str> = line.trim_end_matches('\\').split('"').collect();
            let literals = pieces.iter().skip(usize::from(!open)).step_by(2);
            out.extend(literals.flat_map(|literal| [*literal, " "]));
            open = line.ends_with('\\') && pieces.len().is_multiple_of(2) != open;
        }
        out.push(' ');
    }
    out.split_whitespace().collect::<Vec<_>>().join(" ").to_lowercase()
}

fn has_phrase(text: &str, phrase: &str) -> bool {
    let outside = |c: Option<char>| c.is_none_or(|c| !c.is_alphanumeric());
    text.match_indices(phrase)
        .any(|(at, _)| outside(text[..at].chars().next_back()) && outside(text[at + phrase.len()..].chars().next()))
}

/// Lines that are too long, by their numbers: not rows of a table, nor raw literals, which cannot be broken.
fn too_long(text: &str) -> Vec<usize> {
    let unbreakable = |line: &str| {
        let body = line.trim_start().trim_start_matches(['/', '!']).trim_start();
        body.starts_with('|') || line.contains("r#\"")
    };
    let long = |line: &str| line.chars().count() > COLUMNS && !unbreakable(line);
    text.lines().enumerate().filter(|(_, line)| long(line)).map(|(at, _)| at + 1).collect()
}

/// Files with one of these endings, below the workspace's folders.
fn files(endings: &[&str]) -> Vec<(String, String)> {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let mut found = Vec::new();
    let mut folders: Vec<PathBuf> =
        ["src", "firmware", "host-tests", "tests", "examples", "doc"].map(|folder| root.join(folder)).into();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| endings.iter().any(|&e| ending == e)) {
                let name = path.strip_prefix(&root).unwrap().to_string_lossy().replace('\\', "/");
                found.push((name, fs::read_to_string(&path).unwrap()));
            }
        }
    }
    found.push(("README.md".to_owned(), fs::read_to_string(root.join("README.md")).unwrap()));
    assert!(found.len() > 50, "{} files were read", found.len());
    found
}

fn glossary() -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("doc/glossary.md")).unwrap()
}

#[test]
fn retired_words_are_in_no_public_item_comment_message_or_page() {
    let retired = Retired::of(&glossary());
    let mut faults = Vec::new();
    for (path, text) in files(&["rs", "md", "html"]) {
        // the glossary has them, and the program that reads it its samples
        if path != "doc/glossary.md" && path != "tests/text/main.rs" {
            faults.extend(retired.faults(&path, &text));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn no_line_is_longer_than_the_formatter_allows() {
    let mut faults = Vec::new();
    for (path, text) in files(&["rs"]) {
        // as written by `cargo driveline design --emit rust`, as quoted by the compiler, and with a page's text
        let quoted = ["/cli_emit/", "/compile-fail/", "/hal/table.rs"];
        if !quoted.iter().any(|part| path.contains(part)) {
            faults.extend(too_long(&text).iter().map(|line| format!("{path}:{line}")));
        }
    }
    assert!(faults.is_empty(), "longer than {COLUMNS} columns:\n{}", faults.join("\n"));
}

/// The tests above can fail: planted names, phrases and lines are found, and their neighbours are not.
#[test]
fn planted_words_and_lines_are_found() {
    let retired = Retired::of(
        "| term | meaning | retired |\n|---|---|---|\n| a | b | `governor::Mode`, `Rack`, \"set point\" |\n",
    );
    assert_eq!((retired.names.len(), retired.phrases.len()), (2, 1), "{retired:?}");
    let faults = |path: &str, text: &str| retired.faults(path, text).len();
    assert_eq!(faults("src/governor/sequencer.rs", "    pub enum Mode {"), 1);
    assert_eq!(faults("src/governor.rs", "pub const fn Mode() {}"), 1);
    assert_eq!(faults("src/machine/modes.rs", "pub struct Mode {"), 0);
    assert_eq!(faults("src/hal/a.rs", "    pub Rack: u32,"), 1);
    assert_eq!(faults("src/hal/a.rs", "struct Rack; pub struct RackMount;"), 0);
    assert_eq!(faults("host-tests/a.rs", "/// The Set\n/// point of a drive."), 1);
    assert_eq!(faults("host-tests/a.rs", "let a = b(\"the set \\\n    point\");"), 1);
    assert_eq!(faults("host-tests/a.rs", "let set = point; // resets points"), 0);
    assert_eq!(faults("doc/a.md", "a set point"), 1);

    let line = |columns: usize| format!("fn a() {{}}\n// {}\n", "x".repeat(columns - 3));
    assert_eq!(too_long(&line(COLUMNS)), []);
    assert_eq!(too_long(&line(COLUMNS + 1)), [2]);
    assert_eq!(too_long(&format!("//! | {} |", "x".repeat(COLUMNS))), []);
}
