//! `cargo driveline balance` as an engineer meets it.

use std::process::{Command, Output};

use serde_json::Value;

const FAN: &str = include_str!("../../rotors/fan-balance.toml");

fn balance(text: &str, arguments: &[&str]) -> Output {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("field.toml"), text).unwrap();
    Command::new(env!("CARGO_BIN_EXE_driveline"))
        .args(["balance", "field.toml"])
        .args(arguments)
        .current_dir(folder.path())
        .output()
        .unwrap()
}

fn json(text: &str) -> Value {
    let output = balance(text, &["--json"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// The first line of the error; a faulty file is exit code 2.
fn refused(text: &str) -> String {
    let output = balance(text, &[]);
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty());
    String::from_utf8(output.stderr).unwrap().lines().next().unwrap().to_owned()
}

fn near(value: &Value, expected: f64, tolerance: f64) {
    assert!((value.as_f64().unwrap() - expected).abs() < tolerance, "{value} {expected}");
}

/// Weights of the published case, to the nine digits that balancing.json has it in; the phase of the first is 50.18891873739672 degrees.
#[test]
fn the_published_fan() {
    let outcome = json(FAN);
    let planes = outcome["planes"].as_array().unwrap();
    near(&planes[0]["weight"]["amplitude"], 2.9513806082910325, 3e-9);
    near(&planes[0]["weight"]["degrees"], 50.18891873739672, 1e-7);
    near(&planes[1]["weight"]["amplitude"], 2.8441376945975025, 3e-9);
    near(&planes[1]["weight"]["degrees"], 278.1159343862014, 1e-7);
    near(&outcome["condition"], 2.635601240525888, 1e-9);
    // the holes' residual by hand: what the fitted weights are off by, through the influence coefficients, is below that of half a weight
    // of 0.5 g in each hole
    for row in outcome["rows"].as_array().unwrap() {
        near(&row["predicted"]["amplitude"], 0.0, 1e-12);
        assert!(row["predicted_with_holes"]["amplitude"].as_f64().unwrap() < 2.0 * 4.41 * 0.25 * 2.0_f64.sqrt());
    }
    // (2.9514 + 2.8441) g at 250 mm, U = 9549 G m/n
    near(&outcome["grade"]["now_g_mm"], 5.795518302888535 * 250.0, 1e-6);
    near(&outcome["grade"]["permissible_g_mm"], 9_549.296_585_513_72 * 2.5 * 12.0 / 1480.0, 1e-9);
    assert_eq!(outcome["grade"]["passed"], true);
}

#[test]
fn the_page_and_the_tables() {
    let output = balance(FAN, &["--html", "page.html"]);
    let text = String::from_utf8(output.stdout).unwrap();
    for word in ["Weights", "drive end", "2.95", "50.2", "in hole 3 (60.0°)", "G 18.7", "page: page.html"] {
        assert!(text.contains(word), "{word} in {text}");
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("fan.toml");
    std::fs::write(&file, FAN).unwrap();
    let page = folder.path().join("fan.html");
    let arguments = ["balance", file.to_str().unwrap(), "--json", "--html", page.to_str().unwrap()];
    assert!(Command::new(env!("CARGO_BIN_EXE_driveline")).args(arguments).output().unwrap().status.success());
    let html = std::fs::read_to_string(page).unwrap();
    assert!(html.starts_with("<!doctype html>") && html.matches("<svg").count() >= 4 && !html.contains("NaN"));
}

/// After the correction, a trim from the coefficients that are known.
#[test]
fn a_trim() {
    let after = "\n[[correction]]\nweights = [[2.9, 50], [2.8, 278]]\nrpm = 1480\nreadings = [[0.5, 20], [0.4, 200]]\n";
    let outcome = json(&format!("{FAN}{after}"));
    assert_eq!(outcome["corrections"], 1);
    near(&outcome["rows"][0]["now"]["amplitude"], 0.5, 1e-12);
    assert!(outcome["planes"][0]["weight"]["amplitude"].as_f64().unwrap() < 0.3);
}

#[test]
fn amplitudes_alone() {
    // v0 = 5, influence 0.4 at 60 degrees from it, 10 g: x = 4; |5 + 4 e^{i (60 + alpha)}|
    let amplitude = |alpha: f64| (25.0 + 16.0 + 40.0 * (60.0 + alpha).to_radians().cos()).sqrt();
    let text = format!(
        "name = \"grinder\"\nplanes = [\"wheel\"]\n[amplitudes]\nbaseline = 5.0\nweight = 10.0\n\
         runs = [[0, {}], [120, {}], [240, {}]]\n",
        amplitude(0.0),
        amplitude(120.0),
        amplitude(240.0)
    );
    let outcome = json(&text);
    // 5/4 of 10 g at 180 - 60 degrees
    near(&outcome["weights"][0]["amplitude"], 12.5, 1e-9);
    near(&outcome["weights"][0]["degrees"], 120.0, 1e-9);
}

/// Every wrong use of the file is refused at its place.
#[test]
fn faults_are_placed() {
    let line = |needle: &str, after: &str| {
        let start = FAN.find(after).unwrap();
        FAN[..start + FAN[start..].find(needle).unwrap()].lines().count()
    };
    let zero = FAN.replacen("weight = [2.5, 0] ", "weight = [0, 0] ", 1);
    let said = refused(&zero);
    let at = line("= [2.5, 0]", "[[trial]]");
    assert!(
        said.contains(&format!("field.toml:{at}:10")) && said.contains("trial weight in plane 1 is zero"),
        "{said}"
    );
    let said = refused(&FAN.replacen("rpm = 1482", "rpm = 1600", 1));
    assert!(said.contains("trial[0].rpm") && said.contains("another speed"), "{said}");
    let said = refused(&FAN.replacen("[[4.9, 114], [9.2, 347]]", "[[4.9, 114]]", 1));
    assert!(said.contains("trial[0].readings") && said.contains("1 of them are missing"), "{said}");
    let said = refused(&FAN.replacen("[\"bearing A\", \"bearing B\"]", "[\"bearing A\"]", 1));
    assert!(said.contains("2 planes cannot be told apart by 1 readings"), "{said}");
    let radians = FAN
        .replace("[7.2, 238], [13.5, 296]", "[7.2, 4.154], [13.5, 5.166]")
        .replace("[4.9, 114], [9.2, 347]", "[4.9, 1.99], [9.2, 6.056]")
        .replace("[4.0, 79], [12.0, 292]", "[4.0, 1.379], [12.0, 5.096]");
    let said = refused(&radians);
    assert!(said.contains("baseline.readings") && said.contains("radians"), "{said}");
    let said = refused(&FAN.replacen("plane = \"free end\"", "plane = \"fan end\"", 1));
    assert!(said.contains("trial[1].plane") && said.contains("\"drive end\" or \"free end\""), "{said}");
    let missing = format!("{}{}", &FAN[..FAN.find("[[trial]]\nplane = \"free").unwrap()], "");
    assert!(refused(&missing).contains("a [[trial]] of plane \"free end\""));
    let said = refused(&FAN.replacen("rpm = 1480", "rmp = 1480", 1));
    assert!(said.contains("`baseline.rpm`") || said.contains("unknown key"), "{said}");
    // every prefix of the file is either a whole one or a fault with a place, and none a panic
    for end in (0..FAN.len()).filter(|end| FAN.is_char_boundary(*end)).step_by(7) {
        if let Err(fault) = host_tests::balance_file::parse("field.toml", &FAN[..end]) {
            assert!(fault.to_string().starts_with("field.toml:"), "{fault}");
        }
    }
}
