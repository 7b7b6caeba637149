//! The page on JSON: the keys of every command are those that it lists.

use std::collections::BTreeSet;

use serde_json::Value;

use super::typed;

#[test]
fn every_command_has_the_keys_of_its_row() {
    let folder = tempfile::tempdir().unwrap();
    for example in ["roll", "hoist-start", "three-discs", "fan-balance"] {
        typed(&format!("cargo driveline example {example} > {example}.toml"), folder.path());
    }
    typed("cargo driveline example bench-log > bench.csv", folder.path());
    let page = include_str!("../../../../doc/json.md");
    let mut compared = 0;
    for row in page.lines().filter(|line| line.starts_with("| `")) {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let command = cells[1].trim_matches('`');
        let printed = typed(&format!("cargo driveline {command} --json 2> /dev/null"), folder.path());
        let object: Value =
            serde_json::from_str(&printed).unwrap_or_else(|error| panic!("{command}: {error}: {printed}"));
        let keys: BTreeSet<&str> = object.as_object().unwrap().keys().map(String::as_str).collect();
        let listed: BTreeSet<&str> = cells[2].split(", ").map(|key| key.trim_matches('`')).chain(["schema"]).collect();
        assert_eq!(keys, listed, "{command}");
        compared += 1;
    }
    assert!(compared > 12, "{compared} commands");
}
