//! Work that would take too long is refused, and work that takes long says so.

use std::fmt::Write as _;

use super::run::Place;

/// A chain of so many coordinates.
fn chain(coordinates: usize) -> String {
    let mut text = String::new();
    for k in 0..coordinates {
        let _ = writeln!(text, "[[coordinate]]\nname = \"c{k}\"\ninertia = 1.0");
    }
    for k in 1..coordinates {
        let (a, b) = (k - 1, k);
        let _ = writeln!(text, "[[link]]\nname = \"l{k}\"\nstiffness = 1e3\n[link.terms]\nc{a} = 1.0\nc{b} = -1.0");
    }
    text + "[run]\ntime = 0.01\nstep = 0.001\n"
}

#[test]
fn a_run_of_too_many_coordinates_is_refused() {
    let mut place = Place::new();
    place.put("train.toml", chain(201).as_bytes());
    let ended = place.run(&["simulate", "train.toml", "--json"].map(Into::into), &[]);
    let said = ended.said();
    assert_eq!(ended.code, Some(2), "{said}");
    // at the first one too many
    assert!(said.contains("train.toml:601:") && said.contains("found 201 coordinates, expected at most 200"), "{said}");
}

/// Of 30 equal masses on equal springs the frequencies are 2 sqrt(k/J) sin(pi i/60).
#[test]
fn a_train_of_many_coordinates_has_its_modes() {
    let mut place = Place::new();
    place.put("train.toml", chain(30).as_bytes());
    let ended = place.run(&["modes", "train.toml", "--json"].map(Into::into), &[]);
    assert_eq!(ended.code, Some(0), "{}", ended.said());
    let modes: serde_json::Value = serde_json::from_slice(&ended.out).unwrap();
    let text = modes.to_string();
    let highest = 2.0 * 1e3_f64.sqrt() * (std::f64::consts::PI * 29.0 / 60.0).sin();
    let found = frequencies(&modes);
    assert!(found.iter().any(|found| (found / highest - 1.0).abs() < 1e-9), "{highest}: {text}");
}

/// Every number that is called a frequency.
fn frequencies(value: &serde_json::Value) -> Vec<f64> {
    match value {
        serde_json::Value::Object(object) => {
            let own = object.get("frequency").and_then(serde_json::Value::as_f64);
            object.values().flat_map(frequencies).chain(own).collect()
        }
        serde_json::Value::Array(array) => array.iter().flat_map(frequencies).collect(),
        _ => Vec::new(),
    }
}
