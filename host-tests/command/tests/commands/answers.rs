//! One machine file, the same answer from every command that reads it.

use std::fs;
use std::path::Path;
use std::process::Command;

use cargo_driveline::machine_file::parse;

const SETTINGS: &str = "[encoder]\nlines = 2048\n[control]\nrate_hz = 4000\n[disturbance]\ntorque_accuracy = 4.0\n\
    load_torque_step = 150.0\nwithin = 10.0\n[limits]\ntorque = 600.0\nspeed = 150.0\n";

fn element(kind: &str, rest: &str) -> String {
    format!("[[element]]\nkind = \"{kind}\"\n{rest}\n")
}

/// An element by its word: lower case for what loses nothing.
fn of(word: &str) -> String {
    match word {
        "M" => element("motor", "inertia = 0.5"),
        "K" => element("shaft", "stiffness = 2.0e4\ndamping = 3.0"),
        "k" => element("shaft", "stiffness = 4.0e6\ndamping = 500.0"),
        "r" => element("rotor", "inertia = 0.05"),
        "R" => element("rotor", "inertia = 300.0"),
        "G" => element("gear", "ratio = 20.0\nefficiency = 0.94"),
        "g" => element("gear", "ratio = 20.0"),
        "H" => element("gear", "ratio = 2.0\nefficiency = 0.97"),
        "W" => element("worm", "ratio = 20.0\nefficiency = 0.8\nback_efficiency = 0.7"),
        "P" => element(
            "planetary",
            "sun_teeth = 20\nring_teeth = 90\nmodule = 0.004\nplanets = 3\nsun = 0.013\nplanet = 0.0027\n\
             planet_mass = 3.7\ncarrier = 0.067\nefficiency = 0.97",
        ),
        "B" => element("backlash", "gap = 0.002"),
        "D" => element("drum", "diameter = 0.8"),
        "S" => element("rope", "falls = 2\nstiffness = 2.9e6\ndamping = 3.6e3"),
        "L" => element("lifted", "mass = 3000.0"),
        other => panic!("{other}"),
    }
}

fn file(words: &str) -> String {
    let elements: String = words.split_whitespace().map(of).collect();
    format!("name = \"m\"\n{elements}{SETTINGS}")
}

/// Chains from the motor on. Those with a shaft are machines of every command.
const WITH_A_SHAFT: [&str; 32] = [
    "M K R",
    "M K r G R",
    "M K G R",
    "M G K R",
    "M r G K R",
    "M g K R",
    "M K g R",
    "M K r g R",
    "M K r W R",
    "M W K R",
    "M K r P R",
    "M P K R",
    "M K P R",
    "M K r G k R",
    "M K r H k r H R",
    "M H K r H R",
    "M H K H R",
    "M K r H H R",
    "M K r H r H R",
    "M B K R",
    "M K B R",
    "M K B r G R",
    "M K r G D L",
    "M G D S L",
    "M K r G D S L",
    "M P D S L",
    "M K r P D L",
    "M K r W D L",
    "M k R",
    "M K r B k R",
    "M H k G R",
    "M H K r P D L",
];
const WITHOUT: [&str; 8] = ["M", "M R", "M G R", "M g R", "M W R", "M P R", "M G D L", "M r H r H R"];

/// Whether a command took the file, and what it said.
fn answer(folder: &Path, arguments: &[&str]) -> (bool, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_cargo-driveline"));
    let ended = command.args(arguments).current_dir(folder).output().unwrap();
    let said = [&ended.stdout, &ended.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
    (ended.status.success(), said.concat())
}

/// The chain's losses multiply to its efficiency, whatever lies where.
#[test]
fn losses_on_both_sides_are_all_the_losses() {
    for words in WITH_A_SHAFT.iter().chain(&WITHOUT) {
        let chain = parse("m.toml", &file(words)).unwrap().chain;
        let losses = chain.losses();
        let all = [0, 1].map(|way| losses.before[way] * losses.behind[way]);
        // a few roundings of products
        for (found, expected) in all.into_iter().zip([chain.efficiency(), chain.back_efficiency()]) {
            assert!((found - expected).abs() < 1e-12, "{words}: {found} {expected}");
        }
    }
    // by hand: what lies before and behind the shaft of 2e4 N m/rad
    for (words, before, behind) in [
        ("M K r G R", 1.0, 0.94),
        ("M K G R", 1.0, 0.94),
        ("M G K R", 0.94, 1.0),
        ("M K r H k R", 1.0, 0.97),
        // the shaft behind the gear is the softest: 4e6 over 20 squared
        ("M K r G k R", 0.94, 1.0),
        ("M H K r H R", 0.97, 0.97),
        ("M K r W R", 1.0, 0.8),
    ] {
        let losses = parse("m.toml", &file(words)).unwrap().chain.losses();
        assert_eq!((losses.before[0], losses.behind[0]), (before, behind), "{words}");
    }
}

/// `new` and `campaign` take what `design` gives a drive; `simulate` runs what has a shaft.
#[test]
fn every_command_gives_the_same_answer() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path();
    let run = "[run]\ntime = 0.02\nstep = 1e-3\n";
    for (index, words) in WITH_A_SHAFT.iter().chain(&WITHOUT).enumerate() {
        let has_shaft = !WITHOUT.contains(words);
        let text = file(words);
        let machine = parse("m.toml", &text).unwrap();
        assert_eq!(machine.chain.shafts().is_empty(), !has_shaft, "{words}");
        assert_eq!(machine.losses_of_no_chain().is_some(), !has_shaft && machine.chain.efficiency() < 1.0, "{words}");
        fs::write(folder.join("m.toml"), &text).unwrap();
        fs::write(folder.join("run.toml"), format!("{text}{run}")).unwrap();
        let design = answer(folder, &["design", "m.toml", "--json"]);
        let new = answer(folder, &["new", &format!("p{index}"), "--machine", "m.toml"]);
        // without a shaft there is no load behind one: a drive needs it
        assert!(new.0 == (design.0 && has_shaft) || new.1.contains("margin"), "{words}: {} {}", design.1, new.1);
        let simulated = answer(folder, &["simulate", "run.toml", "--json"]);
        assert!(simulated.0 || !has_shaft, "{words}: {}", simulated.1);
    }
}
