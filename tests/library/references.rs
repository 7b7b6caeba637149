//! Cases of the reference files, and how a number is held to one.

use std::path::Path;

use serde_json::Value;

/// A file of cases; each names its source.
pub fn data(name: &str) -> Value {
    let folders = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().map(|folder| folder.join("tests/data"));
    let path = folders.map(|folder| folder.join(name)).find(|path| path.exists()).expect(name);
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// A case of a file.
pub fn case(file: &str, id: &str) -> Value {
    data(file)["cases"].as_array().unwrap().iter().find(|case| case["id"] == id).unwrap().clone()
}

/// `found` is `expected` within a relative tolerance.
#[track_caller]
pub fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found / expected - 1.0).abs() <= tolerance, "{found}, not {expected}");
}

/// [`close`] to a number of a case.
#[track_caller]
pub fn meets(found: f64, expected: &Value, tolerance: f64) {
    close(found, expected.as_f64().unwrap(), tolerance);
}
