//! The schema of the JSON: each command whose title it has prints the keys that it lists. Types and inner keys are held
//! by `python/tests/test_schema.py`, where Python is.

use std::collections::BTreeSet;

use serde_json::Value;

use super::typed;

#[test]
fn every_command_has_the_keys_of_the_schema() {
    let folder = tempfile::tempdir().unwrap();
    let schema: Value = serde_json::from_str(include_str!("../../../../doc/schema.json")).unwrap();
    let mut files: Vec<_> = schema["files"].as_object().unwrap().iter().filter(|file| file.0 != "$comment").collect();
    // a machine before what is made of it
    files.sort_by_key(|(name, _)| !name.ends_with(".toml"));
    for (name, made) in files {
        match made {
            Value::String(command) => drop(typed(&format!("cargo driveline {command} > {name}"), folder.path())),
            lines => {
                let lines: Vec<_> = lines.as_array().unwrap().iter().filter_map(Value::as_str).collect();
                std::fs::write(folder.path().join(name), lines.join("\n")).unwrap();
            }
        }
    }
    let telemetry = include_bytes!("../../../fuzz/corpus/telemetry/three_channels");
    std::fs::write(folder.path().join("telemetry.bin"), telemetry).unwrap();
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
    assert!(compared > 20, "{compared} commands");
}
