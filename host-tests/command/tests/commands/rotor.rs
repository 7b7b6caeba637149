//! `cargo driveline rotor`: files with their faults placed, tables, JSON, the page.

use std::process::{Command, Output};

use cargo_driveline::machine_file::{parse_rotor, read_rotor};
use serde_json::Value;

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/rotors/three_discs.toml");

/// Influence coefficients and critical speeds of the same rotor by an independent program.
fn file() -> Value {
    serde_json::from_str(include_str!("../../data/flexible_rotor.json")).unwrap()
}

fn driveline(arguments: &[&str]) -> Output {
    let folder = env!("CARGO_TARGET_TMPDIR");
    Command::new(env!("CARGO_BIN_EXE_cargo-driveline")).args(arguments).current_dir(folder).output().unwrap()
}

#[test]
fn the_command_explains_itself_with_examples() {
    let output = driveline(&["rotor", "--help"]);
    let help = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success() && help.contains("Examples:") && help.contains("--json"), "{help}");
}

#[test]
fn json_holds_the_critical_speeds_of_the_file() {
    let output = driveline(&["rotor", FILE, "--json"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    let criticals = found["critical_speeds"].as_array().unwrap();
    let forward: Vec<f64> =
        criticals.iter().filter(|c| c["sense"] == "forward").map(|c| c["speed"].as_f64().unwrap()).collect();
    let expected = file()["rotor"]["synchronous_forward_criticals_Hz_own_FE"].clone();
    for (found, expected) in forward.iter().zip(expected.as_array().unwrap()) {
        let expected = expected.as_f64().unwrap() * std::f64::consts::TAU;
        assert!((found / expected - 1.0).abs() < 1e-6, "{found} {expected}");
    }
    assert!(!forward.is_empty());
    assert_eq!(found["peaks"].as_array().unwrap().len(), 2);
}

#[test]
fn the_page_has_its_plots() {
    let page = format!("{}/three-discs.html", env!("CARGO_TARGET_TMPDIR"));
    let output = driveline(&["rotor", FILE, "--html", &page]);
    let table = String::from_utf8(output.stdout).unwrap();
    assert!(table.contains("Critical speeds") && table.contains("forward"), "{table}");
    let html = std::fs::read_to_string(page).unwrap();
    assert!(html.starts_with("<!doctype html>") && html.contains("Campbell") && !html.contains("NaN"));
    assert_eq!(html.matches("<svg viewBox=\"0 0").count(), 2);
}

#[test]
fn a_fault_is_told_with_its_place() {
    let whole = std::fs::read_to_string(FILE).unwrap();
    let told = |from: &str, to: &str| {
        assert!(whole.contains(from));
        parse_rotor("r.toml", &whole.replacen(from, to, 1)).unwrap_err().to_string()
    };
    assert_eq!(
        told("node = 3\n", "node = 13\n"),
        "r.toml:10:8: `disc[0].node`: found 13, expected a node of the shaft, 0 to 12"
    );
    assert!(told("bore = 0.05 ", "bore = 0.3 ").starts_with("r.toml:12:8: `disc[0].bore`: found 0.3, expected a bore"));
    assert!(told("stiffness_x = 4.0e6", "stifness_x = 4.0e6").contains("`stiffness_x`: a number"));
    assert!(told("pieces = 12", "pieces = 65").contains("1 to 64"));
    assert!(told("highest = 600.0", "highest = -1").starts_with("r.toml:59:11: `speeds.highest`"));
    assert!(told("name = ", "name ").contains("TOML"));
    assert!(parse_rotor("r.toml", "").unwrap_err().to_string().contains("an empty file"));
    let one = whole.replacen("[[bearing]]\nnode = 12\nstiffness_x = 4.0e6\ndamping_x = 2.5e3\n", "", 1);
    assert_ne!(one, whole);
    let held = parse_rotor("r.toml", &one).unwrap_err().to_string();
    assert!(held.contains("`bearing`") && held.contains("meets no stiffness"), "{held}");
}

#[test]
fn no_cut_of_a_file_panics() {
    let whole = std::fs::read_to_string(FILE).unwrap();
    for end in (0..whole.len()).filter(|&end| whole.is_char_boundary(end)).step_by(7) {
        let _ = parse_rotor("cut.toml", &whole[..end]);
    }
}

#[test]
fn a_file_that_is_not_there_is_a_fault_of_the_file() {
    let fault = read_rotor(std::path::Path::new("no/such.toml")).unwrap_err();
    assert_eq!((fault.line, fault.key.as_str()), (0, ""));
}

#[test]
fn a_scene_or_a_variant_that_is_not_there_is_refused() {
    let output = driveline(&["run", "balanced-fan", "--variants", "nonsense"]);
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(text.contains("no variant of `balanced-fan` contains `nonsense`"), "{text}");
    let output = driveline(&["run", "turbine"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8(output.stderr).unwrap().contains("`flexible`"));
}
