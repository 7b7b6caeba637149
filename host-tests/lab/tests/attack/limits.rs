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
