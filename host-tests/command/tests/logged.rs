//! Every public type of the library is in the list that only compiles where all can be logged.

use std::fs;
use std::path::Path;

/// Names of the public types that stand in the library's files, those of its macros by their lists.
fn public_types(folder: &Path, names: &mut Vec<String>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            public_types(&path, names);
            continue;
        }
        for line in fs::read_to_string(&path).unwrap().lines() {
            let line = line.trim_start();
            let after = ["pub struct ", "pub enum "].iter().find_map(|start| line.strip_prefix(start));
            // A macro's own parameter is no name.
            if let Some(rest) = after.filter(|rest| !rest.starts_with('$')) {
                names.push(rest.split(|c: char| !c.is_alphanumeric()).next().unwrap().into());
            }
        }
    }
}

/// What holds complex numbers or matrices of `nalgebra`, which cannot be logged as they are.
const OF_NALGEBRA: [&str; 11] = [
    "Advice",
    "Fitted",
    "FromAmplitudes",
    "Holes",
    "InRun",
    "Influence",
    "LeftOut",
    "Plan",
    "Procedure",
    "Record",
    "Run",
];

/// What owns the parts of a board, or memory that a tick writes.
const OWNERS: [&str; 5] = ["Axis", "EnableChain", "Parts", "Ring", "Store"];

#[test]
fn every_public_type_is_in_the_list() {
    let source = driveline_qemu::clone::workspace().unwrap().join("src");
    let list = fs::read_to_string(source.join("logged.rs")).unwrap();
    let mut names = Vec::new();
    public_types(&source, &mut names);
    assert!(names.len() > 40, "{names:?}");
    let excepted = [&OF_NALGEBRA[..], &OWNERS].concat();
    for name in names.into_iter().filter(|name| !excepted.contains(&name.as_str())) {
        let end = [",", "<", ";", ")"].map(|end| format!("::{name}{end}"));
        assert!(end.iter().any(|entry| list.contains(entry)), "{name} is not in src/logged.rs");
    }
}
