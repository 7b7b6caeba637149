//! The comparison of approaches, and the command that shows it.

use std::process::Command;

use driveline_lab::backlash::backlash_page;
use driveline_lab::backlash::{Approach, Comparison};

/// What was known before: contact gains kept through the gap do better than ignoring it, and gains by the time since
/// contact better than either.
#[test]
fn gains_by_the_time_since_contact_beat_the_others() {
    let comparison = Comparison::run(3.0, 31, |_| {}).unwrap();
    let error = |approach: Approach| {
        let row = comparison.rows.iter().find(|row| row.approach == approach.name()).unwrap();
        assert_eq!(row.each.len(), Comparison::COURSES);
        (row.shaft_torque, row.worst)
    };
    let library = error(Approach::Library);
    for approach in Approach::ALL.into_iter().take(10) {
        assert!(library.0 < error(approach).0 && library.1 < error(approach).1, "{}", approach.name());
    }
    assert!(error(Approach::Keep).0 < error(Approach::Ignore).0);
    assert!(error(Approach::Keep).0 < error(Approach::Switch).0);
    // The three numbers are the same algorithm: they differ by their rounding, which is small beside what an encoder
    // count does: 2 % of the error.
    for approach in [Approach::LibrarySingle, Approach::LibraryFixed] {
        assert!((error(approach).0 - library.0).abs() < 0.02 * library.0, "{}", approach.name());
    }
    let page = backlash_page(&comparison);
    assert!(page.starts_with("<!doctype html>"));
    for approach in Approach::ALL {
        assert!(page.contains(approach.name()), "{}", approach.name());
    }
    assert!(!page.contains("NaN"));
}

fn driveline(arguments: &[&str]) -> (i32, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_lab")).args(arguments).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

#[test]
fn the_command_prints_json_and_refuses_no_seconds() {
    let (code, out, _) = driveline(&["backlash", "--seconds", "1", "--json"]);
    let json: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!((code, json["rows"].as_array().unwrap().len()), (0, Approach::ALL.len()));
    let (code, _, error) = driveline(&["backlash", "--seconds", "0"]);
    assert_eq!(code, 2);
    assert!(error.contains("0 is not in 1..=1000"), "{error}");
    assert_eq!(driveline(&["backlash", "--help"]).0, 0);
}
