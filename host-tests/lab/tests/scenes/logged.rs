//! Every public type of the library derives `defmt::Format`, or says beside itself why not.

use std::fs;
use std::path::Path;

/// Names of the public types below a folder that do neither, and how many types there are.
fn unlogged(folder: &Path, names: &mut Vec<String>) -> usize {
    let mut types = 0;
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            types += unlogged(&path, names);
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        // Attributes and comments above an item.
        let mut above = String::new();
        for line in text.lines().map(str::trim_start) {
            if line.starts_with("#[") || line.starts_with("//") {
                above.push_str(line);
            } else if !line.is_empty() {
                if line.starts_with("pub struct ") || line.starts_with("pub enum ") {
                    types += 1;
                    if !above.contains("derive(defmt::Format)") && !above.contains("// Not logged: ") {
                        names.push(format!("{}: {line}", path.display()));
                    }
                }
                above.clear();
            }
        }
    }
    types
}

#[test]
fn every_public_type_derives_format_or_says_why_not() {
    let mut names = Vec::new();
    let types = unlogged(&driveline_qemu::clone::workspace().unwrap().join("src"), &mut names);
    assert!(types > 200, "{types}");
    assert!(names.is_empty(), "{names:#?}");
}
