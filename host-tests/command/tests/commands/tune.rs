//! `campaign --tune`: the search against functions whose least value is known, and the command on a machine file.

use cargo_driveline::campaign::tune::{Text, Tuned, search};

use super::bench::Bench;

fn key(name: &str, low: f64, high: f64) -> Tuned {
    Tuned { key: name.to_owned(), low, high }
}

/// Functions of one to three values between 1 and 1000, by the logarithms to base ten, their least values, and where
/// points are refused.
type Case = (usize, fn(&[f64]) -> f64, f64);

/// A bowl; a narrow valley beside a wide one that is less deep; a valley askew to the keys; a third of the range
/// refused; a bowl of three.
const CASES: [Case; 5] = [
    (1, |u| 1.0 + (u[0] - 1.234).powi(2), 1.0),
    (1, |u| f64::min(1.0 + 9.0 * (u[0] - 2.5).powi(2), 1.2 + 0.3 * (u[0] - 0.7).powi(2)), 1.0),
    (2, |u| 1.0 + (u[0] + u[1] - 2.7).powi(2) + 0.3 * (u[0] - u[1] + 0.4).powi(2), 1.0),
    (2, |u| if u[0] < 1.0 { f64::NAN } else { 1.0 + (u[0] - 0.5).powi(2) + (u[1] - 2.2).powi(2) }, 1.25),
    (3, |u| 1.0 + (u[0] - 0.9).powi(2) + (u[1] - 1.7).powi(2) + (u[2] - 2.9).powi(2), 1.0),
];

#[test]
fn a_search_comes_within_two_percent_of_the_least_value() {
    for (case, (count, function, least)) in CASES.into_iter().enumerate() {
        let keys: Vec<Tuned> = (0..count).map(|_| key("k", 1.0, 1e3)).collect();
        let mut points = 0;
        let found = search(&keys, |values| {
            points += 1;
            let value = function(&values.iter().map(|value| value.log10()).collect::<Vec<_>>());
            Ok(if value.is_nan() { Err("refused".to_owned()) } else { Ok(value) })
        });
        let found = found.unwrap();
        let best = found[0].objective.unwrap();
        // the project's target of a search beside a global one
        assert!(best <= 1.02 * least, "case {case}: {best} for {least}");
        assert_eq!(points, found.len(), "case {case}: no point is tried twice");
        assert!(points <= 160, "case {case}: {points} points");
    }
}

#[test]
fn numbers_are_replaced_where_they_stand() {
    let text = "# a comment\n[[element]]\nkind = \"motor\"\ninertia = 0.5 # kg m2\n[[element]]\nkind = \"shaft\"\n\
        label = \"coupling\"\nstiffness = 2_000\n[limits]\ntorque = 1e2\n";
    let of = |names: &[&str]| {
        let keys: Vec<Tuned> = names.iter().map(|name| key(name, 1.0, 2.0)).collect();
        Text::of("m.toml", text.to_owned(), &keys)
    };
    let found = of(&["limits.torque", "element[0].inertia", "coupling.stiffness"]).unwrap();
    assert_eq!(found.values(), [100.0, 0.5, 2000.0]);
    let with = found.with(&[7.0, 0.25, 3.0]);
    assert_eq!(with, text.replace("1e2", "7.0").replace("0.5 #", "0.25 #").replace("2_000", "3"));
    assert!(of(&["coupling.stiffness", "element[1].stiffness"]).unwrap_err().contains("expected it once"));
    let missing = of(&["limits.speed"]).unwrap_err();
    assert!(missing.contains("limits.speed") && missing.contains("limits.torque"), "{missing}");
}

#[test]
fn a_wrong_range_names_the_form() {
    for text in ["a", "a=1", "a=2..1", "a=0..1", "a=nan..1", "a=1..inf", "a=-1..1"] {
        assert!(Tuned::parse(text).unwrap_err().contains("KEY=LOW..HIGH"), "{text}");
    }
}

#[test]
fn a_machine_file_is_tuned_and_written() {
    let machine = include_str!("../../machines/roll.toml").replace("rate_hz = 10000", "rate_hz = 2000");
    let bench = Bench::with("roll.toml", &machine);
    let tune = ["campaign", "roll.toml", "--draws", "4", "--tune"];
    let said = bench.refused(&[&tune[..], &["disturbance.torque_accuracy=1..10"]].concat());
    assert!(said.contains("torque_noise = 3.0"), "{said}");

    let within = ["disturbance.within=0.1..100", "--least", "load-torque", "--tuned", "t.toml"];
    let found = bench.json(&[&tune[..], &within].concat());
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    let figures = found["figures"].as_array().unwrap();
    let load = figures.iter().find(|figure| figure["name"] == found["least"][0]).unwrap();
    assert!(number(&load["to"]) <= number(&load["from"]), "{found}");
    let tried = found["tried"].as_array().unwrap();
    assert_eq!(tried[0]["objective"], load["to"]);
    // the file differs by the value alone
    let written = bench.read("t.toml");
    let to = number(&found["to"][0]);
    assert_eq!(written, machine.replace("within = 10.0 ", &format!("within = {to:?} ")));
    // the input is not written over
    bench.refused(&[&tune[..], &["disturbance.within=0.1..100", "--tuned", "roll.toml"]].concat());
    assert_eq!(bench.read("roll.toml"), machine);
}
