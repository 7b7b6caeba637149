//! `cargo driveline rotor`: files with their faults placed, tables, JSON, the page.

use cargo_driveline::machine_file::{parse_rotor, read_rotor};
use serde_json::Value;

use super::bench::{Bench, answered};

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/rotors/three_discs.toml");

/// Influence coefficients and critical speeds of the same rotor by an independent program.
fn file() -> Value {
    serde_json::from_str(include_str!("../../../../tests/data/flexible_rotor.json")).unwrap()
}

#[test]
fn json_holds_the_critical_speeds_of_the_file() {
    let found = Bench::new().json(&["rotor", FILE]);
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
    let bench = Bench::new();
    let table = bench.said(&["rotor", FILE, "--html", "page.html"]);
    assert!(table.contains("Critical speeds") && table.contains("forward"), "{table}");
    let html = bench.read("page.html");
    assert!(html.starts_with("<!doctype html>") && html.contains("Campbell") && !html.contains("NaN"));
    assert_eq!(html.matches("<svg viewBox=\"0 0").count(), 2);
}

/// Bearings that push across as strongly as they hold: far beyond what 2,500 N s/m damp below 600 rad/s.
#[test]
fn a_whirl_that_grows_is_told() {
    let across = "stiffness_x = 4.0e6\ncross_xy = 4.0e6\ncross_yx = -4.0e6\n";
    let three_discs = std::fs::read_to_string(FILE).unwrap();
    let bench = Bench::with("across.toml", three_discs.replace("stiffness_x = 4.0e6", across));
    // along y nothing is damped: at rest those whirls neither grow nor decay
    bench.write("along_x.toml", three_discs.replace("damping_x = 2.5e3", "damping_x = 2.5e3\ndamping_y = 0.0"));
    for (rotor, grows) in [(FILE, false), ("along_x.toml", false), ("across.toml", true)] {
        let said = bench.said(&["rotor", rotor, "--html", "page.html"]);
        assert_eq!(said.contains("\nwarning: unstable at 0 r/min: a whirl of"), grows, "{said}");
        assert_eq!(bench.read("page.html").contains("Warning: unstable"), grows);
    }
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
    assert!(told("pieces = 12", "pieces = 401").contains("1 to 400"));
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

const LONG: &str = r#"
name = "long shaft"
element = [{ length = 2.0, diameter = 0.06, pieces = 10 }]
bearing = [
    { node = 0, stiffness_x = 2.0e7, damping_x = 2.0e3 },
    { node = 10, stiffness_x = 2.0e7, damping_x = 2.0e3 },
]
unbalance = [{ node = 3, amount = 1.0e-4 }, { node = 8, amount = 6.0e-5, angle = 130.0 }]
sensor = [{ node = 0 }, { node = 5 }]
balancing = { planes = [2, 5, 8], modes = 1 }
speeds = { highest = 300.0 }
"#;

/// Static and couple unbalance by hand about the middle of the shaft; nothing of them and of the first mode is left.
#[test]
fn modal_balancing_is_told_and_drawn() {
    let bench = Bench::with("long.toml", LONG);
    let found = bench.json(&["rotor", "long.toml", "--html", "long.html"]);
    let (one, other) = (nalgebra::Complex::new(1e-4, 0.0), nalgebra::Complex::from_polar(6e-5, 130f64.to_radians()));
    let unbalances = found["balancing"]["unbalances"].as_array().unwrap();
    for (unbalance, (of, expected)) in
        unbalances.iter().zip([("static", one + other), ("couple", one * (0.6 - 1.0) + other * (1.6 - 1.0))])
    {
        assert_eq!(unbalance["of"], of);
        // rounding of a sum of two
        assert!((unbalance["before"].as_f64().unwrap() / expected.norm() - 1.0).abs() < 1e-12, "{unbalance}");
    }
    assert_eq!(unbalances[2]["speed"], found["critical_speeds"][1]["speed"]);
    for unbalance in unbalances {
        let [before, after] = ["before", "after"].map(|key| unbalance[key].as_f64().unwrap());
        // rounding, by a condition of some tens
        assert!(after < 1e-12 * before, "{unbalance}");
    }
    let peaks = |of: &Value| -> Vec<f64> {
        of.as_array().unwrap().iter().map(|peak| peak["amplitude"].as_f64().unwrap()).collect()
    };
    // the first critical speed is within the range, and the second is not
    for (now, before) in peaks(&found["balancing"]["peaks"]).into_iter().zip(peaks(&found["peaks"])) {
        assert!(now < 0.05 * before, "{now} {before}");
    }
    let html = bench.read("long.html");
    assert!(html.contains("Vibration with the weights") && html.contains("Balancing weights") && !html.contains("NaN"));
    assert_eq!(html.matches("<svg viewBox=\"0 0").count(), 3);
}

#[test]
fn planes_that_cannot_balance_are_refused() {
    for (from, to, expected) in [
        ("modes = 1", "modes = 2", "`balancing.modes`: found 2, expected a number that goes with the planes"),
        ("[2, 5, 8]", "[2, 5, 5]", "different nodes of the shaft, 0 to 10"),
        ("[2, 5, 8]", "[2, 5, 11]", "different nodes of the shaft, 0 to 10"),
        ("stiffness_x = 2.0e7,", "stiffness_x = 2.0e7, stiffness_y = 1.0e7,", "one stiffness in all directions"),
        ("modes = 1", "modes = 1.5", "a whole number, zero or 1 to 8"),
    ] {
        let text = LONG.replacen(from, to, 1);
        assert_ne!(text, LONG);
        let said = parse_rotor("r.toml", &text).unwrap_err().to_string();
        assert!(said.contains(expected), "{said}");
    }
    let none = LONG.lines().filter(|line| !line.starts_with("unbalance")).collect::<Vec<_>>().join("\n");
    assert!(parse_rotor("r.toml", &none).unwrap_err().to_string().contains("an [[unbalance]] to be balanced"));
}

/// On bearings that give way long before the shaft bends, the first modes are those of a rigid rotor.
#[test]
fn a_mode_of_soft_bearings_is_not_blamed_on_a_plane() {
    let text = std::fs::read_to_string(FILE).unwrap();
    let text = text.replace("stiffness_x = 4.0e6", "stiffness_x = 100.0").replace("damping_x = 2.5e3", "");
    let with = |planes: &str| format!("{text}\n[balancing]\n{planes}\n");
    let said = Bench::with("soft.toml", with("planes = [2, 6, 10]\nmodes = 1")).failed(&["rotor", "soft.toml"]);
    assert!(said.contains("rigid rotor on soft bearings") && said.contains("0 for a rotor"), "{said}");
    // its advice helps
    answered("rotor", &with("planes = [2, 10]\nmodes = 0"));
}

/// On soft bearings, alike at both ends, a uniform shaft moves without bending in its first mode: a weight in its
/// middle is the opposite of the static unbalance. Forward and backward whirls have the same speed, `sqrt(2 k/m)`.
#[test]
fn the_first_mode_of_soft_bearings_takes_the_static_unbalance() {
    let (one, other) = (nalgebra::Complex::new(1e-4, 0.0), nalgebra::Complex::from_polar(6e-5, 130f64.to_radians()));
    let expected = -(one + other);
    let mass = 7850.0 * std::f64::consts::PI / 4.0 * 0.06_f64.powi(2) * 2.0;
    for stiffness in [1.0, 100.0, 300.0, 700.0] {
        let text = LONG.replace("stiffness_x = 2.0e7", &format!("stiffness_x = {stiffness:?}"));
        let found = answered("rotor", &text.replace("[2, 5, 8]", "[5]"));
        // the shaft gives 5 l^3/(384 E I) under its own load, 1.6e-6 m for 2 N/m of the springs; and rounding of the
        // elements' 12 E I/l^3 = 2e8 N/m beside those springs
        let close = 2e-6 * stiffness + 2e8 * f64::EPSILON / stiffness;
        let weight = &found["balancing"]["weights"][0];
        let [amount, angle] = ["amount", "angle"].map(|key| weight[key].as_f64().unwrap());
        let away = nalgebra::Complex::from_polar(amount, angle.to_radians()) - expected;
        // bounce and tilt mix by roundings of the largest eigenvalue, (1e5 rad/s)^2, beside their distance 4 k/m
        let mixed = f64::EPSILON * 1e10 / (4.0 * stiffness / mass);
        assert!(away.norm() < (close + mixed) * expected.norm(), "{stiffness}: {weight} {expected}");
        let bounce = (2.0 * stiffness / mass).sqrt();
        let criticals = &found["critical_speeds"];
        for speed in [&found["balancing"]["unbalances"][2]["speed"], &criticals[0]["speed"], &criticals[1]["speed"]] {
            assert!((speed.as_f64().unwrap() / bounce - 1.0).abs() < close, "{stiffness}: {speed} {bounce}");
        }
    }
}

/// Without a damper nothing decays or grows, and a resonance has no bound; circulatory stiffness makes a whirl grow.
#[test]
fn an_undamped_rotor_has_no_damping_and_no_height_of_its_resonance() {
    let undamped = LONG.replace("damping_x = 2.0e3", "damping_x = 0.0");
    let ratios = |found: &Value| -> Vec<f64> {
        let speeds = found["whirls"].as_array().unwrap().iter();
        speeds.flat_map(|w| w.as_array().unwrap()).map(|w| w["damping_ratio"].as_f64().unwrap()).collect()
    };
    let bench = Bench::with("undamped.toml", &undamped);
    let found = bench.json(&["rotor", "undamped.toml"]);
    assert!(ratios(&found).iter().all(|&ratio| ratio == 0.0), "{found}");
    // the second sensor stands where the first mode bends most
    assert!(found["peaks"][1]["amplitude"].is_null(), "{}", found["peaks"]);
    let said = bench.said(&["rotor", "undamped.toml"]);
    assert!(said.contains("Natural whirls at rest") && said.contains("undamped"), "{said}");
    // the mode that was balanced has no resonance left, though rounding has
    let soft = undamped.replace("stiffness_x = 2.0e7", "stiffness_x = 100.0").replace("[2, 5, 8]", "[5]");
    let found = answered("rotor", &soft);
    assert!(found["peaks"][1]["amplitude"].is_null() && found["balancing"]["peaks"][1]["amplitude"].is_number());
    let driven = LONG.replace("damping_x = 2.0e3", "damping_x = 0.0, cross_xy = 1e5, cross_yx = -1e5");
    let driven = driven.lines().filter(|line| !line.starts_with("balancing")).collect::<Vec<_>>().join("\n");
    let found = answered("rotor", &driven);
    assert!(ratios(&found).iter().any(|&ratio| ratio < -1e-6), "{found}");
}

/// Strong dampers lock the bearings: the resonances are neither those of the undamped rotor nor on even speeds. Expected:
/// the largest of a sweep of 3,000 even speeds and of 54 about each eigenvalue of the damped equations once a turn,
/// refined; matrices integrated from the shapes of a shear-flexible beam, numpy 2.4.
#[test]
fn the_largest_vibration_of_strong_dampers_is_that_of_a_dense_sweep() {
    let text = std::fs::read_to_string(FILE).unwrap();
    for (bearing, expected) in [
        ("damping_x = 2.5e3", [8.195_079_123_548e-5, 8.273_920_987_172e-5]),
        ("stiffness_y = 2e6\ndamping_x = 1e5\ndamping_y = 3e4", [1.618_172_309_507e-5, 1.660_296_718_022e-5]),
        ("stiffness_y = 2e6\ndamping_x = 1e6\ndamping_y = 2e5", [6.982_573_954_608e-5, 7.009_635_551_589e-5]),
        ("stiffness_y = 2e6\ndamping_x = 1e8\ndamping_y = 1e7", [2.593_894_953_413e-3, 2.594_141_755_761e-3]),
    ] {
        let found = answered("rotor", &text.replace("damping_x = 2.5e3", bearing));
        for (peak, expected) in found["peaks"].as_array().unwrap().iter().zip(expected) {
            let amplitude = peak["amplitude"].as_f64().unwrap();
            // the narrowest half-width, 1e-4 of the speed, is 1e6 times the rounding of the stiffness
            assert!((amplitude / expected - 1.0).abs() < 1e-6, "{bearing}: {peak} {expected}");
        }
    }
}

/// Some seconds of work have a line on standard error for every five of them.
#[test]
fn a_rotor_of_many_pieces_says_what_takes_long() {
    let text = std::fs::read_to_string(FILE).unwrap();
    let text = text.replace("pieces = 12", "pieces = 200").replace("node = 12", "node = 200");
    let bench = Bench::with("many.toml", text);
    let begun = std::time::Instant::now();
    let output = bench.run(&["rotor", "many.toml", "--json"]);
    let (took, said) = (begun.elapsed().as_secs(), String::from_utf8(output.stderr).unwrap());
    assert!(output.status.success(), "{said}");
    // two stages, each of up to five seconds without a word
    assert!(took < 11 || said.contains("vibration over the speed"), "{took} s: {said}");
}
