//! Critical speeds and the modes of trains, as `cargo driveline modes` tells them.

use super::bench::{Bench, answered};

/// What `modes` finds, and its page.
pub fn modes(text: &str) -> (serde_json::Value, String) {
    let bench = Bench::with("machine.toml", text);
    (bench.json(&["modes", "machine.toml", "--html", "page.html"]), bench.read("page.html"))
}

/// A motor and a roll behind a gear of five; omega^2 = k (J1 + J2)/(J1 J2) with J2 = 50/25 and k = 600: 500 + 100.
const ELEMENTS: &str = "name = \"mill\"\n[[element]]\nkind = \"motor\"\ninertia = 1.0\n[[element]]\nkind = \"shaft\"\n\
    stiffness = 400.0\n[[element]]\nkind = \"gear\"\nratio = 5.0\n[[element]]\nkind = \"rotor\"\ninertia = 50.0\n\
    [encoder]\nlines = 2048\n[control]\nrate_hz = 10000\n[disturbance]\ntorque_accuracy = 1.0\nload_torque_step = 1.0\n\
    within = 1.0\n[limits]\ntorque = 100.0\nspeed = 100.0\n";

#[test]
fn a_critical_speed_within_ten_percent_of_the_running_range_is_flagged() {
    let omega = 600.0_f64.sqrt();
    // order 1 of the motor at omega, order 2 at omega/2; order 3 of the roll's shaft at 5 omega/3
    let excited = "[[excitation]]\nname = \"motor\"\norders = [1, 2]\n\
                   [[excitation]]\nname = \"roll\"\nratio = 5\norders = [3]\n";
    let flags = |least: f64, greatest: f64| {
        let text = format!("{ELEMENTS}[running]\nleast = {least}\ngreatest = {greatest}\n{excited}");
        let (found, page) = modes(&text);
        let title = "Campbell diagram";
        assert!(
            page.contains(title) && page.contains("point failed") == found.to_string().contains("\"flagged\":true")
        );
        let critical = found["critical"].as_array().unwrap().clone();
        let speeds: Vec<f64> = critical.iter().map(|c| c["speed"].as_f64().unwrap()).collect();
        for (speed, expected) in speeds.iter().zip([omega / 2.0, omega, 5.0 * omega / 3.0]) {
            // eigenvalues of two masses, to rounding
            assert!((speed / expected - 1.0).abs() < 1e-13, "{speeds:?}");
        }
        [0, 1, 2].map(|i| critical[i]["flagged"].as_bool().unwrap())
    };
    assert_eq!(flags(0.9 * omega, 1.1 * omega), [false, true, false]);
    // on either side of the ten percent, below and above the range
    assert_eq!(flags(omega / 0.901, 1.2 * omega), [false, true, false]);
    assert_eq!(flags(omega / 0.899, 1.2 * omega), [false, false, false]);
    assert_eq!(flags(0.6 * omega, omega / 1.099), [false, true, false]);
    assert_eq!(flags(0.6 * omega, omega / 1.101), [false, false, false]);
    assert_eq!(flags(0.4 * omega, 2.0 * omega), [true, true, true]);
}

#[test]
fn without_excitations_there_is_no_diagram() {
    let (found, page) = modes(ELEMENTS);
    assert!(found["critical"].as_array().unwrap().is_empty() && !page.contains("Campbell"));
}

#[test]
fn modes_of_a_closed_ring_are_those_of_the_closed_form() {
    // three equal discs in a ring of equal shafts: one rigid turning, and twice omega^2 = 3 k/J
    let disc = |name: &str| format!("[[coordinate]]\nname = \"{name}\"\ninertia = 2.0\n");
    let shaft =
        |a: &str, b: &str| format!("[[link]]\nname = \"{a}{b}\"\nbetween = [\"{a}\", \"{b}\"]\nstiffness = 54.0\n");
    let discs = ["a", "b", "c"].map(disc).concat();
    let shafts = [shaft("a", "b"), shaft("b", "c"), shaft("a", "c")].concat();
    let (found, page) = modes(&format!("name = \"ring\"\n{discs}{shafts}[run]\ntime = 1\nstep = 0.1\n"));
    assert_eq!(found["rigid_motions"], 1);
    for mode in 0..2 {
        let omega = found["resonances"][mode]["frequency"].as_f64().unwrap();
        // eigenvalues of a matrix of three, to rounding
        assert!((omega - 9.0).abs() < 1e-13, "{omega}");
    }
    assert!(found["resonances"].as_array().unwrap().len() == 2 && page.contains("<svg"));
}

/// Ten percent either side of each critical speed, joined where they meet, up to the largest running speed.
#[test]
fn barred_speeds_are_printed() {
    let omega = 600.0_f64.sqrt();
    let excited = "[[excitation]]\nname = \"motor\"\norders = [1, 1.15, 2]\n";
    let text = format!("{ELEMENTS}[running]\nleast = 5.0\ngreatest = {}\n{excited}", 0.95 * omega);
    let (found, page) = modes(&text);
    let ranges: Vec<f64> = found["barred"]
        .as_array()
        .unwrap()
        .iter()
        .flat_map(|range| [&range[0], &range[1]])
        .map(|edge| edge.as_f64().unwrap())
        .collect();
    // 1/1.15 and 1 of omega lie within a tenth of each other
    let expected = [0.45 * omega, 0.55 * omega, 0.9 / 1.15 * omega, 1.1 * omega];
    assert_eq!(ranges.len(), 4, "{ranges:?}");
    for (edge, expected) in ranges.iter().zip(expected) {
        // eigenvalues of two masses, to rounding
        assert!((edge / expected - 1.0).abs() < 1e-13, "{ranges:?}");
    }
    assert!(page.contains("Barred speeds"));
    assert!(answered("modes", ELEMENTS)["barred"].as_array().unwrap().is_empty());
}
