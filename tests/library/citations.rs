//! Citations: a source is cited for what it prints, a heading of it beside "derived" alone.

use std::fs;
use std::path::PathBuf;

/// What the text of a source prints, by `doc/makers/theory.md`, what it has a mere heading for, and words of what it does not
/// print, each beside a part that it was taken for.
struct Source {
    tag: &'static str,
    printed: &'static [&'static str],
    headings: &'static [&'static str],
    not: &'static [(&'static str, &'static str)],
}

const SOURCES: [Source; 5] = [
    Source {
        tag: "wang 1989",
        printed: &[
            "§1-1",
            "§1-2",
            "§1-3",
            "(1-6)",
            "(1-7)",
            "(1-8)",
            "(1-11)",
            "(1-12)",
            "(1-14)",
            "(1-15)",
            "(1-16)",
            "example 1-1",
            "example 1-4",
            "example 1-5",
        ],
        headings: &["ch. 3"],
        not: &[
            ("", "efficien"),
            ("", "/eta"),
            ("", "supplies the loss"),
            ("", "gpa"),
            ("", "j'(phi)"),
            ("example 1-4", "teeth"),
            ("(1-16)", "32 l"),
        ],
    },
    Source {
        tag: "pfützner 1980",
        printed: &["§1.1", "§1.2", "(1.2a) to (1.2c)", "(1.6)", "(1.10)"],
        headings: &["ch. 1", "ch. 2", "§1.4.3", "§1.5", "§3.4"],
        not: &[("§1.1", "decay")],
    },
    Source {
        tag: "tang 1994",
        printed: &["§1.1", "(1.4)", "(1.5)", "(1.6)", "(1.7)", "(1.8)", "(1.9)"],
        headings: &[],
        not: &[("", "tilt"), ("", "kg m2"), ("(1.4)", "e_i'")],
    },
    Source {
        tag: "huang 1987",
        printed: &["ch. 1", "ch. 2", "§2.2", "tables 1-2 to 1-4"],
        headings: &["ch. 3 to 7", "ch. 8 and 12", "ch. 8", "ch. 12"],
        not: &[],
    },
    Source {
        tag: "notes ch. 5",
        printed: &[""],
        headings: &[],
        not: &[("", "a w + v"), ("", "u_per"), ("", "g m /"), ("", "lambda"), ("", "reciprocating")],
    },
];

/// The citations of a text that its source does not bear out, each with the sentence before it.
fn unprinted(text: &str) -> Vec<String> {
    let mut faults = Vec::new();
    for Source { tag, printed, headings, not } in &SOURCES {
        for (at, _) in text.match_indices(tag) {
            let rest = &text[at + tag.len()..];
            // a row of the table of sources names what was read
            if rest.starts_with(" |") {
                continue;
            }
            let before = text[..at].replace("ch. ", "ch._");
            let ends = ["]", "|", "```", ". "].map(|end| before.rfind(end).map_or(0, |at| at + end.len()));
            let start = ends.into_iter().max().unwrap_or(0);
            let sentence = &text[start..at];
            let is_derived = sentence.contains("heading") && sentence.contains("derived");
            // the parts that are cited: `§1-3, (1-16)`, `end of example 1-5`
            let mut parts = rest.trim_start().trim_start_matches("(end of ");
            let mut cited = Vec::new();
            let known = || printed.iter().chain(headings.iter().filter(|_| is_derived));
            while let Some(part) = known().filter(|part| parts.starts_with(**part)).max_by_key(|part| part.len()) {
                cited.push(*part);
                parts = parts[part.len()..].trim_start_matches(", ").trim_start_matches(" and ");
                if part.is_empty() {
                    break;
                }
            }
            // what follows names no more parts
            let more = ["§", "(1", "ch.", "part", "example", "table", "to "].iter().any(|more| parts.starts_with(more));
            let taken_for = not.iter().find(|(part, word)| {
                (part.is_empty() || cited.contains(part)) && sentence.contains(word) && !is_derived_of(sentence)
            });
            if cited.is_empty() || more || taken_for.is_some() {
                let end = rest.char_indices().nth(24).map_or(rest.len(), |(end, _)| end);
                faults.push(format!("{sentence}{tag}{}", &rest[..end]));
            }
        }
    }
    faults
}

/// Whether a citation says itself that the formula is derived and what of it the source prints.
fn is_derived_of(sentence: &str) -> bool {
    sentence.rsplit('[').next().is_some_and(|bracket| bracket.starts_with("derived"))
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

#[test]
fn a_source_is_cited_for_what_it_prints() {
    let mut faults = Vec::new();
    for (path, text) in files(&["rs", "md", "toml"]) {
        if path != "tests/library/citations.rs" {
            let text = prose(&path, &text).replace(" # ", " ");
            faults.extend(unprinted(&text).into_iter().map(|fault| format!("{path}: {fault}")));
        }
    }
    assert!(faults.is_empty(), "{} citations that the source does not print:\n{}", faults.len(), faults.join("\n"));
}

/// The test above can fail: planted citations are found, and their neighbours are not.
#[test]
fn planted_citations_are_found() {
    for (text, count) in [
        ("k [wang 1989 §1-3, (1-16)]", 0),
        ("k [wang 1989 §1-3, (1-18)]", 1),
        ("t [huang 1987 part 2]", 1),
        ("t [derived; headings: huang 1987 ch. 3 to 7]", 0),
        ("t [huang 1987 ch. 3 to 7]", 1),
        ("turns and tilts [tang 1994 (1.6)]", 1),
        ("turns [tang 1994 (1.6)]", 0),
        ("the size that tang 1994 calculates with", 1),
        ("carries t/eta [wang 1989 §1-3]", 1),
        ("v = a w + v0 [notes ch. 5]", 1),
        ("delta [notes ch. 5]", 0),
        ("that of wang 1989 example 1-4: sun 20", 0),
        ("20 teeth as in wang 1989 example 1-4", 1),
    ] {
        assert_eq!(unprinted(text).len(), count, "{text}");
    }
}
