//! The schema of the JSON: each command whose title it has prints the keys that it lists. Types and inner keys are held
//! by `python/tests/test_schema.py`, where Python is.

use std::collections::BTreeSet;

use serde_json::Value;

use super::typed;

#[test]
fn every_command_has_the_keys_of_the_schema() {
    let folder = tempfile::tempdir().unwrap();
    for example in ["roll", "hoist-start", "gear-pair", "three-discs", "fan-balance"] {
        typed(&format!("cargo driveline example {example} > {example}.toml"), folder.path());
    }
    typed("cargo driveline example bench-log > bench.csv", folder.path());
    let schema: Value = serde_json::from_str(include_str!("../../../../doc/schema.json")).unwrap();
    let keys = |object: &Value| object.as_object().unwrap().keys().cloned().collect::<BTreeSet<_>>();
    let mut compared = 0;
    for of in schema["$defs"].as_object().unwrap().values() {
        let Some(command) = of["title"].as_str() else { continue };
        let printed = typed(&format!("cargo driveline {command} --json 2> /dev/null"), folder.path());
        let object: Value =
            serde_json::from_str(&printed).unwrap_or_else(|error| panic!("{command}: {error}: {printed}"));
        assert_eq!(keys(&object), keys(&of["properties"]), "{command}");
        assert_eq!(object["schema"], of["properties"]["schema"]["const"], "{command}");
        compared += 1;
    }
    assert!(compared > 15, "{compared} commands");
}
