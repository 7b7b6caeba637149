//! `cargo driveline simulate` as a user meets it.

use std::f64::consts::TAU;

use cargo_driveline::machine_file::parse_train;
use driveline_solver::plant::train::{Coordinate, FourBar, FourBarPins, Orders, Source, StrokeLoad, Train, rubbing};
use serde_json::Value;

use super::bench::{Bench, answered, number};

fn machine(name: &str) -> String {
    format!("{}/trains/{name}.toml", env!("CARGO_MANIFEST_DIR"))
}

/// Two masses on an undamped shaft under a constant torque: between 0 and twice the static torque
/// `[derived; headings: Huang 1987 ch. 3 to 7]`.
const STEP: &str = "name = \"step\"\n\
    [[coordinate]]\nname = \"motor\"\ninertia = 1.2\n\
    [[coordinate]]\nname = \"load\"\ninertia = 0.3\n\
    [[link]]\nname = \"shaft\"\nbetween = [\"motor\", \"load\"]\nstiffness = 850.0\n\
    [[torque]]\non = \"motor\"\nkind = \"constant\"\ntorque = 100.0\n\
    [run]\ntime = 0.5\nstep = 1e-3\n";

#[test]
fn the_dynamic_factor_of_a_step_is_two() {
    // the shaft carries what the load's share of the inertia takes: 100 x 0.3/1.5
    let bench = Bench::with("step.toml", STEP.replace("stiffness = 850.0", "stiffness = 850.0\nstatic = 20.0"));
    let found = bench.json(&["simulate", "step.toml", "--csv", "step.csv", "--html", "step.html"]);
    let shaft = &found["links"][0];
    // undamped step, exact to rounding: extremes are found between the samples
    assert!((shaft["dynamic_factor"].as_f64().unwrap() - 2.0).abs() < 1e-13, "{shaft}");
    let omega = (850.0_f64 * (1.0 / 1.2 + 1.0 / 0.3)).sqrt();
    let peak = shaft["greatest_time"].as_f64().unwrap();
    let swings = (peak * omega / std::f64::consts::PI).round();
    // near the top an error in time of 1e-8 changes the torque by rounding only
    // of equal peaks the first is told
    assert!(swings == 1.0 && (peak - swings * std::f64::consts::PI / omega).abs() < 1e-6, "{peak}");
    assert!(found["proof"][0].as_f64().unwrap() < 1e-8);
    let table = bench.read("step.csv");
    let mut lines = table.lines();
    assert_eq!(lines.next(), Some("time,\"motor speed\",\"load speed\",\"shaft force\""));
    assert_eq!(lines.next(), Some("0,0,0,0"));
    assert_eq!(table.lines().count(), 502);
    for line in table.lines().skip(1) {
        let numbers: Vec<f64> = line.split(',').map(|n| n.parse().unwrap()).collect();
        let expected = 20.0 * (1.0 - (omega * numbers[0]).cos());
        // the closed form over five hundred samples, each rounded
        assert!((numbers[3] - expected).abs() < 1e-10, "{line}");
    }
    let page = bench.read("step.html");
    assert!(page.starts_with("<!doctype html>") && page.contains("<svg") && !page.contains("NaN"));
}

#[test]
fn the_machines_in_the_repository_run_and_are_proven() {
    for (name, words) in [
        ("gear-pair", ["mesh", "separation"]),
        ("spur-pair", ["mesh pinion bearing 2 X", "pump shaft"]),
        ("two-stage", ["mesh 2", "machine shaft"]),
        ("gear-branch", ["left mesh", "right shaft"]),
        ("hoist-start", ["rope", "ground"]),
        ("girder", ["girder spring", "contact"]),
        ("travel", ["gear", "separation"]),
        ("tilting", ["train 2", "separation"]),
    ] {
        let text = Bench::new().said(&["simulate", &machine(name)]);
        assert!(text.contains("proven: a second integrator"), "{text}");
        assert!(words.iter().all(|word| text.contains(word)), "{text}");
    }
}

/// Lightly damped and lightly loaded, between both flanks, for a long time: chaos. No run is the only one of its start.
#[test]
fn a_sensitive_run_is_proven_in_pieces_and_says_so() {
    let text = std::fs::read_to_string(machine("gear-pair")).unwrap();
    let text = text
        .replace("damping = 3561.695654463696", "damping = 10.0")
        .replace("gap = 1.6e-4", "gap = 4e-6")
        .replace("elongation = 9.1e-5", "elongation = 2.6e-5")
        .replace("torque = 250.0", "torque = 5.0")
        .replace("torque = -595.2380952380952", "torque = -11.904761904761905")
        .replace("time = 0.02", "time = 0.2");
    let bench = Bench::with("rattle.toml", text);
    let found = bench.json(&["simulate", "rattle.toml"]);
    assert!(found["sensitive"]["pieces"].as_u64().unwrap() > 0 && found["proof"][0].as_f64().unwrap() <= 1e-8);
    assert!(found["sensitive"]["from"].as_f64().unwrap() < 0.2);
    let said = bench.said(&["simulate", "rattle.toml"]);
    assert!(said.contains("sensitive: proven from the start up to") && said.contains("one possible run"), "{said}");
    let found = bench.json(&["simulate", "rattle.toml", "--unproven"]);
    assert!(found["proof"].is_null() && found["sensitive"].is_null());
}

/// The gear pair that is shipped, for fifty times its time.
#[test]
fn the_gear_pair_runs_for_a_second() {
    let text = std::fs::read_to_string(machine("gear-pair")).unwrap();
    let found = answered("simulate", &text.replace("time = 0.02", "time = 1.0"));
    assert!(found["proof"][0].as_f64().unwrap() <= 1e-8 && found["sensitive"].is_null(), "{}", found["proof"]);
}

/// Two masses on a damped shaft under a torque: with `w` and `D` of the free swing, the elastic torque overshoots to
/// `1 + exp(-pi D/sqrt(1 - D^2))` of the static one; `modes` shows the same eigenvalue.
#[test]
fn the_elastic_factor_and_the_damped_vibration_of_a_step() {
    let text = STEP.replace("stiffness = 850.0", "stiffness = 850.0\nstatic = 20.0\ndamping = 2.0");
    let bench = Bench::with("damped.toml", text);
    let found = bench.json(&["simulate", "damped.toml"]);
    let shares = 1.0 / 1.2 + 1.0 / 0.3;
    let (omega, decay) = ((850.0_f64 * shares).sqrt(), 0.5 * 2.0 * shares);
    let damped = (omega * omega - decay * decay).sqrt();
    let expected = 1.0 + (-std::f64::consts::PI * decay / damped).exp();
    // without an event none was located closer
    assert!(found["proof"][1].is_null() && bench.said(&["simulate", "damped.toml"]).contains("no events"));
    let shaft = &found["links"][0];
    // roundings of the run
    assert!((shaft["elastic_factor"].as_f64().unwrap() - expected).abs() < 1e-12, "{shaft} {expected}");
    assert!(shaft["dynamic_factor"].as_f64().unwrap() > expected);
    let found = bench.json(&["modes", "damped.toml"]);
    let one = &found["damped"][0];
    assert_eq!(found["damped"].as_array().unwrap().len(), 1, "{found}");
    // an eigenvalue of a matrix of three
    assert!((one["decay"].as_f64().unwrap() / decay - 1.0).abs() < 1e-12, "{one}");
    assert!((one["frequency"].as_f64().unwrap() / damped - 1.0).abs() < 1e-12, "{one}");
    let found = answered("modes", STEP);
    assert!(found["damped"].as_array().unwrap().is_empty(), "{found}");
}

#[test]
fn every_fault_of_a_file_has_its_place() {
    // what is replaced, by what, where the fault is then told, and a word of the sentence
    let faults = [
        ("inertia = 1.2", "inertia = 0", "2.toml:4:11", "kg m²"),
        ("inertia = 1.2", "", "2.toml:2:1", "inertia"),
        ("name = \"load\"", "name = \"motor\"", "2.toml:6:8", "no other"),
        ("[\"motor\", \"load\"]", "[\"motor\", \"lode\"]", "2.toml:10:11", "\"load\""),
        ("[\"motor\", \"load\"]", "[\"motor\", \"motor\"]", "2.toml:10:11", "two of them"),
        ("between = [\"motor\", \"load\"]", "terms = { motor = 1, lode = -1 }", "2.toml:10:22", "unknown name"),
        ("between = [\"motor\", \"load\"]", "terms = { motor = 0 }", "2.toml:10:19", "not zero"),
        ("stiffness = 850.0", "stiffness = -1", "2.toml:11:13", "N m/rad"),
        ("stiffness = 850.0", "stiffness = 1\nstifness = 2", "2.toml:12:1", "unknown key"),
        ("stiffness = 850.0", "stiffness = 1\nrope = 1", "2.toml:12:8", "true or false"),
        ("stiffness = 850.0", "stiffness = 1\nground = \"motor\"", "2.toml:10:11", "`ground` beside it"),
        ("stiffness = 850.0", "stiffness = 1\nterms = { motor = 1 }", "2.toml:10:11", "`terms` beside it"),
        ("kind = \"constant\"", "kind = \"kloss\"", "2.toml:12:1", "breakdown"),
        ("kind = \"constant\"", "kind = \"constnat\"", "2.toml:14:8", "kloss"),
        ("kind = \"constant\"\ntorque = 100.0", "kind = \"table\"\npoints = [[0, 1], [0, 2]]", "2.toml:15:10", "after"),
        ("kind = \"constant\"\ntorque = 100.0", "kind = \"table\"\npoints = [[0, 1], [1]]", "2.toml:15:19", "rows"),
        ("step = 1e-3", "step = 1e-9", "2.toml:18:8", "time"),
        ("step = 1e-3", "", "2.toml:16:1", "step"),
        ("[run]", "[start]\nkind = \"pretensioned\"\nheld = \"motr\"\n[run]", "2.toml:18:8", "\"motor\""),
        ("[run]\ntime = 0.5\nstep = 1e-3", "", "2.toml:1:1", "run"),
    ];
    assert!(parse_train("2.toml", STEP).is_ok());
    let mut wrong = Vec::new();
    for (old, new, place, word) in faults {
        let text = STEP.replacen(old, new, 1);
        match parse_train("2.toml", &text) {
            Ok(_) => wrong.push(format!("{old} -> {new} was taken")),
            Err(fault) => {
                let sentence = fault.to_string();
                if !(sentence.starts_with(place) && sentence.contains(word)) {
                    wrong.push(format!("{old} -> {new}: {sentence}"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A motor, a drum and a load; what is put in for `inertia`, `stiffness` and `damping` belongs to the drum and its
/// shaft.
fn drum(inertia: &str, stiffness: &str, damping: &str) -> String {
    format!(
        "name = \"drum\"\n\
         [[coordinate]]\nname = \"motor\"\ninertia = 1.2\n\
         [[coordinate]]\nname = \"drum\"\ninertia = {inertia}\n\
         [[coordinate]]\nname = \"load\"\ninertia = 0.3\n\
         [[link]]\nname = \"shaft\"\nbetween = [\"motor\", \"drum\"]\nstiffness = {stiffness}\ndamping = {damping}\n\
         [[link]]\nname = \"rope\"\nbetween = [\"drum\", \"load\"]\nstiffness = 850.0\ndamping = 0.1\n\
         [[torque]]\non = \"motor\"\nkind = \"constant\"\ntorque = 100.0\n\
         [run]\ntime = 0.5\nstep = 1e-3\n"
    )
}

#[test]
fn a_train_that_is_too_stiff_for_its_run_is_refused_at_once_with_place_and_range() {
    let refused = |text: &str| {
        let said = Bench::with("stiff.toml", text).refused(&["simulate", "stiff.toml", "--json"]);
        let value: Value = serde_json::from_str(&said).unwrap();
        (value["at"]["line"].as_u64().unwrap(), value["error"].as_str().unwrap().to_owned())
    };
    // 1e11/1e-12 is a decay of 1e23 1/s; what is heavy beside it does not slow it
    let (line, error) = refused(&drum("1e-12", "850.0", "1e11"));
    // the damping, 1e12 times the other's, is as odd as the inertia: either may be called
    assert!(line == 5 || line == 11, "{error}");
    assert!(error.contains("damping of 1.0e11 on an inertia of 1.0e-12, a rate of 1.0e23 1/s"), "{error}");
    // sqrt(850 (1/1e-12 + 1/1.2)) = 2.9e7 rad/s; 1e6 in 0.5 s are 2e6 1/s, whose square is less by 2.1e2
    let (line, error) = refused(&drum("1e-12", "850.0", "0.0").replace("damping = 0.1", "damping = 0.0"));
    assert_eq!(line, 5, "{error}");
    assert!(error.contains("a stiffness of 8.5e2 on an inertia of 1.0e-12, a rate of 2.9e7 1/s"), "{error}");
    let (line, error) = refused(&drum("0.02", "850.0", "1e11"));
    assert_eq!(line, 11, "{error}");
    assert!(error.contains("`shaft`") && error.contains("damping of at most"), "{error}");
    // elements are called by their own place
    let text = std::fs::read_to_string(machine("hoist-start")).unwrap();
    let heading = text.lines().position(|line| line.contains("inertia = 0.08")).unwrap() - 2;
    let (line, error) = refused(&text.replace("inertia = 0.08 ", "inertia = 1e-12 "));
    assert_eq!(line as usize, heading, "{error}");
    assert!(error.contains("`brake drum`") && error.contains("an inertia of at least"), "{error}");
}

#[test]
fn what_is_stiff_but_not_too_stiff_is_solved_and_proven() {
    // 0.1/2e-6 = 5e4 1/s, and twice that of the shafts' swing together
    let found = answered("simulate", &drum("2e-6", "850.0", "0.0").replace("time = 0.5", "time = 0.05"));
    assert!(found["proof"][0].as_f64().unwrap() < 1e-8);
}

/// A run that its steps do not divide would be another run: it is refused, with a step that does.
#[test]
fn a_time_that_is_no_multiple_of_the_step_is_refused() {
    let text = STEP.replace("time = 0.5\n", "time = 0.5004\n");
    let said = parse_train("step.toml", &text).unwrap_err().to_string();
    assert!(said.contains("step") && said.contains("divides the run into whole steps"), "{said}");
    // 0.3/1e-3 is 299.99999999999994 in floating point, and whole in the file
    parse_train("step.toml", &STEP.replace("time = 0.5\n", "time = 0.3\n")).unwrap();
}

/// A motor whose torque rises with its speed runs away: the run ends, and says what has grown.
#[test]
fn a_run_that_grows_without_bound_is_refused_by_name() {
    let runaway = "kind = \"line\"\nstall = 100.0\nslope = -2000.0";
    let bench = Bench::with("runaway.toml", STEP.replace("kind = \"constant\"\ntorque = 100.0", runaway));
    let said = bench.failed(&["simulate", "runaway.toml", "--json"]);
    assert!(said.contains("grows without bound") && said.contains("motor"), "{said}");
}

/// An external gear turns what is behind it the other way: speeds in the ratio, once the shaft's swing is taken off by
/// the momentum `J_1 w_1 + J_2 w_2/ratio`, which is the torque times the time.
#[test]
fn a_negative_ratio_is_an_external_gear() {
    let text = STEP.replace("stiffness = 850.0", "stiffness = 850.0\nratio = -2.0");
    let file = parse_train("step.toml", &text).unwrap();
    let mut motion = file.motion.clone();
    motion.advance(0.5);
    let momentum = 1.2 * motion.speed(0) - 0.3 * motion.speed(1) / 2.0;
    // roundings of the run
    assert!((momentum / 50.0 - 1.0).abs() < 1e-11 && motion.speed(1) < 0.0, "{momentum}");
    let said = parse_train("step.toml", &text.replace("-2.0", "0.0")).unwrap_err().to_string();
    assert!(said.contains("negative where"), "{said}");
}

/// What a machine file of elements has beside them.
fn settings() -> String {
    let hoist = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/machines/hoist.toml")).unwrap();
    hoist[hoist.find("[encoder]").unwrap()..].to_owned()
}

/// Motor, an element with losses, a shaft and a load that hangs on a drum of 0.4 m.
fn hanging(element: &str) -> String {
    format!(
        "name = \"hanging\"\n[[element]]\nkind = \"motor\"\ninertia = 0.5\n{element}\
         [[element]]\nkind = \"shaft\"\nstiffness = 9.0e4\n\
         [[element]]\nkind = \"rotor\"\ninertia = 2.0\n\
         [[element]]\nkind = \"drum\"\ndiameter = 0.4\n\
         [[element]]\nkind = \"lifted\"\nmass = 100.0\n\
         [run]\ntime = 0.2\nstep = 1e-3\n{}",
        settings()
    )
}

/// A load of 196 N m behind a ratio of 10 pulls its motor by eta' of 19.6 N m: once the swing is taken off, the motor's
/// momentum and eta' times the load's are eta' times the weight's torque times the time.
#[test]
fn worms_planetary_sets_and_gears_lose_power_in_a_run() {
    let worm = "[[element]]\nkind = \"worm\"\nratio = 10.0\nefficiency = 0.7\nback_efficiency = 0.5\n";
    let gear = "[[element]]\nkind = \"gear\"\nratio = 10.0\nefficiency = 0.9\n";
    // 1 + 81/9 = 10 from sun to carrier; of its own inertias a part in 1e12 is left
    let set = "[[element]]\nkind = \"planetary\"\nsun_teeth = 9\nring_teeth = 81\nmodule = 0.001\nplanets = 3\n\
        sun = 1e-12\nplanet = 1e-12\nplanet_mass = 1e-12\ncarrier = 1e-12\nefficiency = 0.8\n";
    for (element, back) in [(worm, 0.5), (gear, 0.9), (set, 0.8)] {
        let file = parse_train("hanging.toml", &hanging(element)).unwrap();
        let mut motion = file.motion.clone();
        motion.advance(0.2);
        // at the motor: rotor and mass over the ratio's square; the standard's gravity of the library
        let load = (2.0 + 100.0 * 0.2 * 0.2) / 100.0;
        let weight = 100.0 * 9.80665 * 0.2 / 10.0;
        let momentum = 0.5 * motion.speed(0) + back * load * motion.speed(1);
        // a swing that lets the power turn round for a moment would leave a share; it has none here
        assert!((momentum / (-back * weight * 0.2) - 1.0).abs() < 1e-9, "{back}: {momentum}");
    }
}

/// Elements that lock themselves hold their load without a torque of the motor: of -0.2 of the power back the load would
/// have to be driven down.
#[test]
fn elements_that_lock_themselves_hold_their_load_in_a_run() {
    let back = "efficiency = 0.4\nback_efficiency = -0.2\n";
    let worm = format!("[[element]]\nkind = \"worm\"\nratio = 10.0\n{back}");
    let gear = format!("[[element]]\nkind = \"gear\"\nratio = 10.0\n{back}");
    let set = format!(
        "[[element]]\nkind = \"planetary\"\nsun_teeth = 9\nring_teeth = 81\nmodule = 0.001\nplanets = 3\n\
        sun = 1e-12\nplanet = 1e-12\nplanet_mass = 1e-12\ncarrier = 1e-12\n{back}"
    );
    for element in [worm, gear, set] {
        let file = parse_train("hanging.toml", &hanging(&element)).unwrap();
        let mut motion = file.motion.clone();
        motion.advance(2.0);
        assert_eq!(motion.speed(0), 0.0, "{element}");
        // behind the coupling and no shaft the gear holds as well
        let shaft = "[[element]]\nkind = \"shaft\"\nstiffness = 9.0e4\n";
        let flange = "[[element]]\nkind = \"rotor\"\ninertia = 0.2\n";
        let rigid = hanging(&format!("{shaft}{flange}{element}")).replacen(&format!("{element}{shaft}"), &element, 1);
        let file = parse_train("hanging.toml", &rigid).unwrap();
        let mut motion = file.motion.clone();
        motion.advance(2.0);
        assert_eq!((motion.links(), motion.speed(0), motion.speed(1)), (1, 0.0, 0.0), "{element}");
    }
}

/// A motor of 0.5 kg m2 with a flange of 0.2 kg m2 lowers its load by itself: together they speed up as `(J_f + eta J_b)
/// w' = -eta W`, at the mean of the coupling's swing.
#[test]
fn a_gear_without_a_shaft_behind_it_loses_power_in_a_run() {
    let shaft = "[[element]]\nkind = \"shaft\"\nstiffness = 9.0e4\ndamping = 100.0\n";
    let gear = "[[element]]\nkind = \"gear\"\nratio = 10.0\nefficiency = 0.7\n";
    let front = format!("{shaft}[[element]]\nkind = \"rotor\"\ninertia = 0.2\n{gear}");
    let behind = "[[element]]\nkind = \"shaft\"\nstiffness = 9.0e4\n";
    let text = hanging(&front).replacen(&format!("{gear}{behind}"), gear, 1);
    let mut motion = parse_train("hanging.toml", &text).unwrap().motion.clone();
    motion.advance(1.0);
    let before = motion.speed(1);
    motion.advance(1.0);
    let (load, weight) = ((2.0 + 100.0 * 0.2 * 0.2) / 100.0, 100.0 * 9.80665 * 0.2 / 10.0);
    let expected = -0.7 * weight / (0.7 + 0.7 * load);
    assert!(((motion.speed(1) - before) / expected - 1.0).abs() < 1e-9, "{}", motion.speed(1) - before);
}

/// A belt carries its own losses: driven back, of its torque `F` on the load the motor gets `eta F`, and keeps with the
/// load `J_1 w_1 + eta J_2 w_2 = -eta W t`, the load's side at the motor by the ratio of the pulleys.
#[test]
fn a_belt_loses_power_in_a_run() {
    let belt = "[[element]]\nkind = \"belt\"\ndriving = 0.1\ndriven = 0.4\nstiffness = 4e6\nefficiency = 0.9\n";
    let shaft = "[[element]]\nkind = \"shaft\"\nstiffness = 9.0e4\n";
    let file = parse_train("hanging.toml", &hanging(belt).replace(shaft, "")).unwrap();
    let mut motion = file.motion.clone();
    motion.advance(0.2);
    let load = (2.0 + 100.0 * 0.2 * 0.2) / 16.0;
    let weight = 100.0 * 9.80665 * 0.2 / 4.0;
    let momentum = 0.5 * motion.speed(0) + 0.9 * load * motion.speed(1);
    assert!((momentum / (-0.9 * weight * 0.2) - 1.0).abs() < 1e-9, "{momentum}");
}

/// Losses that no shaft can carry are refused by the element's name.
#[test]
fn losses_without_a_shaft_are_refused_by_name() {
    let text = "name = \"stiff\"\n[[element]]\nkind = \"motor\"\ninertia = 0.5\n\
        [[element]]\nkind = \"gear\"\nlabel = \"gearbox\"\nratio = 10.0\nefficiency = 0.9\n\
        [[element]]\nkind = \"rotor\"\ninertia = 2.0\n\
        [run]\ntime = 0.2\nstep = 1e-3\n";
    let said = parse_train("stiff.toml", &format!("{text}{}", settings())).unwrap_err().to_string();
    assert!(said.contains("gearbox") && said.contains("no shaft before or behind it"), "{said}");
}

/// Drums of constant inertia under a torque of twice a turn, `M cos 2 phi`: `J w^2/2` swings by `2 M/2`, and J as
/// much as is missing has the delta that the class permits.
#[test]
fn the_swing_of_the_energy_and_the_flywheel_are_those_of_the_closed_form() {
    for k in 0..20 {
        let (inertia, swing, speed) = (0.5 * 1.2_f64.powi(k), 20.0 * 1.3_f64.powi(k), 20.0 + f64::from(k));
        let text = format!(
            "name = \"drum\"\n[[coordinate]]\nname = \"drum\"\ninertia = {inertia:?}\nspeed = {speed:?}\n[[torque]]\n\
             on = \"drum\"\nkind = \"orders\"\nharmonics = [[2.0, {swing:?}, 0.0]]\n[run]\ntime = 0.1\nstep = \
             0.01\ncycle = \"drum\"\n"
        );
        let cycle = &answered("simulate", &text)["cycle"];
        assert!((number(&cycle["swing"]["energy"]) / swing - 1.0).abs() < 1e-6, "{cycle}");
        let mean = 0.5 * (number(&cycle["greatest"]) + number(&cycle["least"]));
        for class in cycle["swing"]["classes"].as_array().unwrap() {
            for (permissible, missing) in [0, 1].map(|end| (&class["permissible"][end], &class["missing"][end])) {
                let expected = (swing / (mean * mean * number(permissible)) - inertia).max(0.0);
                assert!((number(missing) - expected).abs() < 1e-6 * (expected + inertia), "{class} {expected}");
            }
        }
    }
}

/// A crank drive under a torque of twice a turn keeps its energy: with the flywheel that is missing, with the
/// mean energy as it was, delta is the permissible one.
#[test]
fn the_flywheel_of_a_crank_gives_the_delta_that_it_is_for() {
    let cycle = |flywheel: f64, speed: f64| {
        let crank = format!(
            "inertia = {:?}\nspeed = {speed:?}\n[coordinate.crank]\nradius = 0.08\nrod = 0.3\nslider_mass = 40.0\n\
             [[torque]]\non = \"crank\"\nkind = \"orders\"\nharmonics = [[2.0, 60.0, 0.0]]\n",
            3.0 + flywheel
        );
        let text = format!(
            "name = \"crank\"\n[[coordinate]]\nname = \"crank\"\n{crank}[run]\ntime = 0.1\nstep = 0.01\ncycle = \
             \"crank\"\n"
        );
        answered("simulate", &text)["cycle"].clone()
    };
    let alone = cycle(0.0, 20.0);
    let (mean, mut tried) = (0.5 * (number(&alone["greatest"]) + number(&alone["least"])), 0);
    for class in alone["swing"]["classes"].as_array().unwrap() {
        for (permissible, missing) in [0, 1].map(|k| (number(&class["permissible"][k]), number(&class["missing"][k]))) {
            if missing == 0.0 {
                assert!(number(&alone["delta"]) <= permissible, "{class}");
                continue;
            }
            // at a dead centre the crank has its own 3 kg m2
            let start = ((3.0 * 400.0 + missing * mean * mean) / (3.0 + missing)).sqrt();
            let with = cycle(missing, start);
            let [most, least] = ["greatest", "least"].map(|end| number(&with[end]));
            let delta = 0.5 * (most * most - least * least) / (mean * mean);
            // parabolas through 4096 values leave 1e-9 of a swing of such orders
            assert!((delta / permissible - 1.0).abs() < 1e-6, "{class} {delta}");
            tried += 1;
        }
    }
    assert!(tried >= 9, "{tried}");
}

/// A file of one crank with its run, and what is put in for the mechanism and the torque over its stroke.
fn press(mechanism: &str, stroke: &str) -> String {
    format!(
        "name = \"press\"\n[[coordinate]]\nname = \"crank\"\n{mechanism}\
         [[torque]]\non = \"crank\"\nkind = \"stroke\"\n{stroke}\
         [run]\ntime = 1.0\nstep = 1e-2\ncycle = \"crank\"\n"
    )
}

/// The steady cycles of a four-bar press and of a slider: their coefficients are those of shooting with Runge-Kutta
/// over the closed forms of the velocities, `host-tests/solver/tests/solver/train/linkage.rs`.
#[test]
fn the_steady_cycle_of_a_press_has_the_fluctuation_of_shooting() {
    let line = |stall: f64, slope: f64| {
        format!("[[torque]]\non = \"crank\"\nkind = \"line\"\nstall = {stall:?}\nslope = {slope:?}\n")
    };
    let bars = "inertia = 6.0\nspeed = 15.0\n[coordinate.four_bar]\ncrank = 0.1\ncoupler = 0.35\nrocker = 0.3\n\
        ground = 0.4\ncoupler_inertia = 0.4\nrocker_inertia = 2.5\n";
    let slider = "inertia = 12.0\nspeed = 30.0\n[coordinate.crank]\nradius = 0.08\nrod = 0.3\nslider_mass = 40.0\n";
    let cases = [
        (press(bars, "force = -300.0\nfrom = 0.8\nto = 2.4\n") + &line(400.0, 20.0), 0.059_542_048_661),
        (press(slider, "force = -9000.0\nfrom = 3.6\nto = 5.2\n") + &line(900.0, 20.0), 0.049_523_572_944),
    ];
    for (text, expected) in cases {
        let bench = Bench::with("press.toml", &text);
        let found = bench.json(&["simulate", "press.toml"]);
        let delta = found["cycle"]["delta"].as_f64().unwrap();
        assert!((delta / expected - 1.0).abs() < 1e-7, "{delta} {expected}");
        let proof = found["cycle"]["proof"].as_array().unwrap();
        assert!(proof.iter().all(|share| share.as_f64().unwrap() <= 1e-8), "{proof:?}");
        let said = bench.said(&["simulate", "press.toml"]);
        assert!(said.contains("Steady cycle") && said.contains("cycle proven: it comes back to"), "{said}");
        let said = bench.said(&["simulate", "press.toml", "--unproven"]);
        assert!(said.contains("cycle not proven: the proof was left out"), "{said}");
    }
    // without a line nothing brings it to a speed of its own
    let text = press(slider, "force = -9000.0\nfrom = 3.6\nto = 5.2\n").replace("speed = 30.0", "speed = 300.0");
    let said = Bench::with("press.toml", text).failed(&["simulate", "press.toml"]);
    assert!(said.contains("does not settle to a cycle of 1 turn within"), "{said}");
}

/// What no mechanism is, is refused at its own key.
#[test]
fn a_mechanism_that_cannot_be_is_refused_at_its_key() {
    let slider = "[coordinate.crank]\nradius = 0.08\nrod = 0.3\nslider_mass = 40.0\n";
    let bars = |ground: f64| {
        let bars = "[coordinate.four_bar]\ncrank = 0.1\ncoupler = 0.3\nrocker = 0.3\nrocker_inertia = 1.0\n";
        format!("{bars}ground = {ground:?}\n")
    };
    let inertia = "inertia = 1.0\nspeed = 30.0\n";
    let stroke = "force = -1.0\nfrom = 0.8\nto = 2.4\n";
    for (mechanism, stroke, said) in [
        (format!("{slider}{}", bars(0.4)), stroke, "one of `crank`, `four_bar`, `toggle` and `cam`"),
        // they turn round up to 0.5, where they lie in one line
        (bars(0.499_999_999), stroke, "not so near to lying in one line"),
        (bars(0.6), stroke, "shorter than the other two together"),
        (slider.to_owned(), "force = -1.0\nfrom = 1.0\nto = 1.0\n", "another angle than `from`"),
    ] {
        let error = parse_train("press.toml", &press(&format!("{inertia}{mechanism}"), stroke)).err().unwrap();
        assert!(error.to_string().contains(said), "{error}");
    }
}

/// A slider's weight over the whole turn takes `m g` times its way from the energy; a table of inertia with the values
/// of the crank's closed form does what the crank does; a torque over an arc of two turns does its work once in two.
#[test]
fn weights_tables_of_inertia_and_arcs_of_two_turns_do_their_work() {
    let (r, l) = (0.08_f64, 0.3_f64);
    let way = |angle: f64| r * angle.cos() + (l * l - (r * angle.sin()).powi(2)).sqrt();
    let inertia = |angle: f64| {
        let (sine, cosine) = angle.sin_cos();
        40.0 * (-r * sine - r * r * sine * cosine / (l * l - r * r * sine * sine).sqrt()).powi(2)
    };
    let crank = "inertia = 12.0\nspeed = 30.0\n[coordinate.crank]\nradius = 0.08\nrod = 0.3\nslider_mass = 40.0\n";
    let table: Vec<f64> = (0..101).map(|i| inertia(std::f64::consts::TAU * f64::from(i) / 101.0)).collect();
    let table = format!("inertia = 12.0\nspeed = 30.0\ninertia_table = {table:?}\n");
    let arc = "[[torque]]\non = \"crank\"\nkind = \"arc\"\ntorque = 70.0\nfrom = 0.7\nto = 8.0\nturns = 2\n";
    let weighted = press(crank, "force = -392.0\n") + arc;
    let stroke = "[[torque]]\non = \"crank\"\nkind = \"stroke\"\nforce = -392.0\n";
    for (text, weight) in [
        (weighted.clone(), 392.0),
        (press(&table, "").replace("[[torque]]\non = \"crank\"\nkind = \"stroke\"\n", "") + arc, 0.0),
    ] {
        let mut motion = parse_train("press.toml", &text).unwrap().motion;
        for step in 1..=400 {
            motion.advance(2e-3);
            let (angle, speed) = (motion.angle(0), motion.speed(0));
            let double = angle.rem_euclid(2.0 * std::f64::consts::TAU);
            let pairs = (angle / (2.0 * std::f64::consts::TAU)).floor();
            let work = 70.0 * (pairs * 7.3 + double.clamp(0.7, 8.0) - 0.7) + weight * (way(0.0) - way(angle));
            let energy = 0.5 * (12.0 + inertia(angle)) * speed * speed;
            // inertia of 1e-12 by its series; roundings of the run
            assert!((energy / (0.5 * 12.0 * 900.0 + work) - 1.0).abs() < 1e-10, "{step}: {energy} {work}");
        }
    }
    let refused = |text: String| parse_train("press.toml", &text).unwrap_err().to_string();
    let said = refused(weighted.replace("[coordinate.crank]\nradius = 0.08\nrod = 0.3\nslider_mass = 40.0\n", ""));
    assert!(said.contains("a `crank`, a `four_bar`, a `toggle` or a `cam`"), "{said}");
    let said = refused(press("inertia = 1.0\ninertia_table = [1.0, 2.0]\n", "").replace(stroke, ""));
    assert!(said.contains("an odd number of values"), "{said}");
    let bars = "inertia = 6.0\n[coordinate.four_bar]\ncrank = 0.31\ncoupler = 0.35\nrocker = 0.3\nground = 0.4\n";
    let said = refused(press(bars, "force = 1.0\n"));
    assert!(said.contains("the shortest bar"), "{said}");
}

/// The modes of a train need no `[run]`: two masses on a shaft, `sqrt(k (1/J_1 + 1/J_2))`.
#[test]
fn modes_of_a_train_need_no_run() {
    let found = answered("modes", &STEP.replace("[run]\ntime = 0.5\nstep = 1e-3\n", ""));
    let omega = found["resonances"][0]["frequency"].as_f64().unwrap();
    // some roundings
    assert!((omega / (850.0_f64 * (1.0 / 1.2 + 1.0 / 0.3)).sqrt() - 1.0).abs() < 1e-14, "{omega}");
    assert_eq!((found["rigid_motions"].as_u64(), found["resonances"].as_array().unwrap().len()), (Some(1), 1));
}

/// Of two laws of a mesh's stiffness one would count without a word; a pair's wheels have names of their own.
#[test]
fn a_mesh_has_one_law_and_names_of_its_own() {
    let fault = |text: &str| {
        let diagnostic = cargo_driveline::machine_file::parse_train("pair.toml", text).unwrap_err();
        (diagnostic.key.clone(), diagnostic.to_string())
    };
    let pair = std::fs::read_to_string(machine("gear-pair")).unwrap();
    let second = "[link.teeth]\nof = \"pinion\"\ncount = 20\ncontact_ratio = 1.6\nsingle = 0.6\n";
    let at = pair.find("[link.spur]").or_else(|| pair.find("[link.harmonics]")).unwrap();
    let (key, text) = fault(&format!("{}{second}\n{}", &pair[..at], &pair[at..]));
    assert!(key.starts_with("link[0].") && text.contains("one of `spur`, `teeth` and `harmonics`"), "{text}");
    let spur = std::fs::read_to_string(machine("spur-pair")).unwrap();
    let named = spur.replacen("name = \"motor\"", "name = \"mesh pinion\"", 1);
    assert_ne!(named, spur);
    let (key, text) = fault(&named);
    assert!(key == "spur_pair[0].name" && text.contains("`mesh pinion`"), "{text}");
}

/// The frequencies of a spur pair in a file are those of the solver's, whose fourteen a dense matrix has: without motor
/// and pump the pair alone. A chain through two meshes has those of its inertias at the motor.
#[test]
fn gears_in_files_have_the_frequencies_of_their_equations() {
    let text = std::fs::read_to_string(machine("spur-pair")).unwrap();
    let (head, pair) = text.split_once("[[spur_pair]]").unwrap();
    assert!(head.contains("[[coordinate]]"));
    let pair = pair.split("[[link]]").next().unwrap();
    let alone = cargo_driveline::machine_file::parse_train_for_modes("pair", &format!("[[spur_pair]]{pair}")).unwrap();
    let found = alone.train.modes().unwrap();
    assert_eq!((found.omega.len(), found.rigid_motions(), alone.links.len()), (14, 1, 13));
    // M and K from the equations: the mesh, then shaft and bearings of each wheel; its stiffness is that of the teeth,
    // 0.6 x 6.8e8 + 0.4 x 4e8
    let mesh = 5.68e8;
    let bodies = [
        (1.8, 0.0021, 0.0395, 2e8, [0.4, 0.5], [0.06, 0.09], [[3e8, 2.5e8], [2.1e8, 1.75e8]]),
        (9.0, 0.065, 0.094, 4e8, [0.8, 0.7], [0.05, 0.1], [[5e8, 3.5e8], [3.5e8, 2.45e8]]),
    ];
    let (mut m, mut k) = (vec![0.0_f64; 14], nalgebra::DMatrix::<f64>::zeros(14, 14));
    let mut spring = |terms: &[(usize, f64)], stiffness: f64| {
        for (i, a) in terms {
            for (j, b) in terms {
                k[(*i, *j)] += stiffness * a * b;
            }
        }
    };
    spring(&[(0, 1.0), (2, bodies[0].2), (7, -1.0), (9, -bodies[1].2)], mesh);
    for (first, (mass, inertia, _, shaft, bearings, [a, b], stiffness)) in [0, 7].into_iter().zip(bodies) {
        (m[first], m[first + 1], m[first + 2]) = (mass, mass, inertia);
        for (way, stiffness) in stiffness.iter().enumerate() {
            let (one, two) = (first + 3 + way, first + 5 + way);
            spring(&[(first + way, 1.0), (one, -b / (a + b)), (two, -a / (a + b))], shaft);
            for (bearing, at) in [one, two].into_iter().enumerate() {
                m[at] = bearings[bearing];
                spring(&[(at, 1.0)], stiffness[bearing]);
            }
        }
    }
    let scaled = nalgebra::DMatrix::from_fn(14, 14, |i, j| k[(i, j)] / (m[i] * m[j]).sqrt());
    let mut expected: Vec<f64> = nalgebra::SymmetricEigen::new(scaled).eigenvalues.iter().copied().collect();
    expected.sort_by(f64::total_cmp);
    for (omega, expected) in found.omega.iter().zip(&expected).skip(1) {
        // the dense method rounds by 1e-16 of the largest eigenvalue, a hundred times the smallest
        assert!((omega * omega / expected - 1.0).abs() < 1e-10, "{omega} {expected}");
    }
    let chain = |name: &str, inertias: &[f64], shafts: &[(usize, usize, f64)]| {
        let file = cargo_driveline::machine_file::read_train(std::path::Path::new(&machine(name))).unwrap();
        // singular values of the shafts' twists, scaled by stiffness and inertia
        let scaled = nalgebra::DMatrix::from_fn(shafts.len(), inertias.len(), |shaft, at| {
            let (from, to, k) = shafts[shaft];
            (f64::from(u8::from(at == from)) - f64::from(u8::from(at == to))) * (k / inertias[at]).sqrt()
        });
        let mut expected: Vec<f64> = scaled.singular_values().iter().copied().collect();
        expected.sort_by(f64::total_cmp);
        for (omega, expected) in file.train.modes().unwrap().omega.iter().skip(1).zip(expected) {
            // rounding of the highest, a thousand times the lowest
            assert!((omega / expected - 1.0).abs() < 1e-11, "{name}: {omega} {expected}");
        }
    };
    let (one, two) = (0.0395_f64 / 0.094, 0.0536_f64 / 0.172);
    let mean = |contact: f64, double: f64, single: f64| (contact - 1.0) * double + (2.0 - contact) * single;
    let (a, b) = (one * one, one * one * two * two);
    let first = mean(1.6, 6.8e8, 4.0e8) * 0.0395 * 0.0395;
    let second = a * mean(1.55, 1.1e9, 6.8e8) * 0.0536 * 0.0536;
    chain(
        "two-stage",
        &[0.05, 0.0021, a * 0.065, a * 0.006, b * 0.55, b * 6.0],
        &[(0, 1, 4e4), (1, 2, first), (2, 3, a * 3e5), (3, 4, second), (4, 5, b * 2e6)],
    );
    let (wheel, side) = (two * two, (two * 0.172 / 0.08).powi(2));
    let off = wheel * 8e8 * 0.172 * 0.172;
    chain(
        "gear-branch",
        &[0.4, 0.006, wheel * 0.55, side * 0.02, side * 0.3, side * 0.02, side * 0.5],
        &[
            (0, 1, 9e4),
            (1, 2, mean(1.55, 1.1e9, 6.8e8) * 0.0536 * 0.0536),
            (2, 3, off),
            (2, 5, off),
            (3, 4, side * 5e4),
            (5, 6, side * 7e4),
        ],
    );
}

/// Toggle, cam and crank under a force over a part of their stroke that passes the angle zero, with friction on the
/// guide: the energy is that of the start and the work, `F dy - R |dy|`.
#[test]
fn mechanisms_by_their_keys_do_their_work() {
    let lift: Vec<f64> = (0..21).map(|i| 0.02 * (1.0 - (TAU * f64::from(i) / 21.0).cos())).collect();
    let cam = move |angle: f64| 0.02 * (1.0 - angle.cos());
    let crank = |angle: f64| 0.08 * angle.cos() + (0.3_f64 * 0.3 - (0.08 * angle.sin()).powi(2)).sqrt();
    let knee = |angle: f64| {
        let (x, y) = (0.06 * angle.cos(), 0.06 * angle.sin());
        let across = (0.55 - x).hypot(y);
        let at_pin = (0.5 * 0.5 + across * across - 0.3 * 0.3) / (2.0 * 0.5 * across);
        let coupler = (-y).atan2(0.55 - x) + at_pin.acos();
        let rocker = (y + 0.5 * coupler.sin()).atan2(x + 0.5 * coupler.cos() - 0.55);
        0.3 * (rocker - 1.9).cos() + (0.32_f64 * 0.32 - (0.3 * (rocker - 1.9).sin()).powi(2)).sqrt()
    };
    let keys = [
        format!("[coordinate.cam]\nlift = {lift:?}\nmass = 8.0\nfriction = 5.0\n"),
        "[coordinate.crank]\nradius = 0.08\nrod = 0.3\nslider_mass = 8.0\nfriction = 5.0\n".to_owned(),
        "[coordinate.toggle]\ncrank = 0.06\ncoupler = 0.5\nrocker = 0.3\nground = 0.55\nlink = 0.32\n\
         direction = 1.9\nslider_mass = 8.0\nfriction = 5.0\n"
            .to_owned(),
    ];
    let ways: [&dyn Fn(f64) -> f64; 3] = [&cam, &crank, &knee];
    for (keys, way) in keys.into_iter().zip(ways) {
        let text = press(&format!("inertia = 2.0\nspeed = 20.0\n{keys}"), "force = 30.0\nfrom = 5.5\nto = 0.8\n");
        let mut motion = parse_train("press.toml", &text).unwrap().motion;
        // work by fine steps of the way, from arc to arc
        let steps = 40_000.0;
        let (mut work, mut angle) = (0.0, 0.0);
        let slope = |angle: f64| (way(angle + 1e-6) - way(angle - 1e-6)) / 2e-6;
        for _ in 0..600 {
            motion.advance(1e-3);
            let end = motion.angle(0);
            let count = (steps * (end - angle) / TAU).ceil();
            let step = (end - angle) / count;
            for _ in 0..count as usize {
                let within = (angle + 0.5 * step).rem_euclid(TAU);
                let moved = way(angle + step) - way(angle);
                let force = if (0.8..=5.5).contains(&within) { 0.0 } else { 30.0 };
                work += force * moved - 5.0 * moved.abs();
                angle += step;
            }
            let inertia = 2.0 + 8.0 * slope(angle).powi(2);
            let expected = 0.5 * 400.0 * (2.0 + 8.0 * slope(0.0).powi(2)) + work;
            let energy = 0.5 * inertia * motion.speed(0).powi(2);
            // ends of arcs and dead centres within a step of 1.6e-4 rad: 3e-4 N m each; slopes by differences
            assert!((energy - expected).abs() < 1e-5 * expected, "{angle}: {energy} {expected}");
        }
    }
    let text = press(
        "inertia = 2.0\nspeed = 20.0\n[coordinate.crank]\nradius = 0.08\nrod = 0.3\nslider_mass = 8.0\n\
         friction = 5.0\n",
        "force = 1.0\n",
    );
    let brake = "[[torque]]\non = \"crank\"\nkind = \"constant\"\ntorque = -80.0\n";
    let bench = Bench::with("back.toml", text.replace("cycle = \"crank\"\n", "") + brake);
    let said = bench.failed(&["simulate", "back.toml"]);
    assert!(said.contains("\"crank\" turns backwards"), "{said}");
    let at_rest = text.replace("speed = 20.0", "angle = 1.0").replace("cycle = \"crank\"\n", "");
    let said = Bench::with("rest.toml", at_rest).failed(&["simulate", "rest.toml"]);
    assert!(said.contains("\"crank\" starts at rest"), "{said}");
    let said =
        parse_train("x", &press("inertia = 1.0\n[coordinate.cam]\nlift = [0.0, 0.1]\nmass = 1.0\n", "force = 1.0\n"));
    assert!(said.unwrap_err().to_string().contains("an odd number of values"));
}

/// Pins that nothing loads let a crank turn either way; those that a force loads are of forward motion, and a start
/// backwards is named as such.
#[test]
fn pins_are_of_forward_motion_where_they_take_a_torque() {
    let crank = "inertia = 2.0\nspeed = -20.0\n[coordinate.crank]\nradius = 0.08\nrod = 0.3\nslider_mass = 8.0\n\
                 [coordinate.crank.pins]\ncoefficient = 0.1\nmain = 0.03\n";
    let loaded = press(crank, "force = 30.0\n").replace("cycle = \"crank\"\n", "");
    let bare = loaded.replace("[[torque]]\non = \"crank\"\nkind = \"stroke\"\nforce = 30.0\n", "");
    let massless = bare.replace("slider_mass = 8.0", "slider_mass = 0.0");
    assert!(bare.len() < loaded.len());
    for (text, without_effect) in [
        (massless, true),
        (bare, false),
        (loaded.replace("coefficient = 0.1", "coefficient = 0.0"), true),
        (loaded.replace("main = 0.03\n", ""), true),
        (loaded.clone(), false),
    ] {
        let bench = Bench::with("pins.toml", text);
        if without_effect {
            bench.said(&["simulate", "pins.toml"]);
        } else {
            let said = bench.refused(&["simulate", "pins.toml"]);
            assert!(said.contains("-20 of \"crank\", whose friction is that of forward motion"), "{said}");
        }
    }
}

/// A rod so near the crank's radius that its way has no series: refused at the rod. One a thousandth longer runs, with
/// pins as well.
#[test]
fn a_rod_barely_longer_than_its_crank_is_refused_at_the_rod() {
    let pins = "[coordinate.crank.pins]\ncoefficient = 0.1\nmain = 0.03\nwrist = 0.02\n";
    let text = |rod: f64, pins: &str| {
        let crank = format!(
            "inertia = 2.0\nspeed = 20.0\n[coordinate.crank]\nradius = 0.1\nrod = {rod:?}\nslider_mass = 8.0\n"
        );
        press(&(crank + pins), "force = 30.0\n")
    };
    for pins in ["", pins] {
        let text_of = text(0.100_000_01, pins);
        let fault = parse_train("press", &text_of).unwrap_err();
        assert_eq!(text_of.lines().nth(fault.line - 1), Some("rod = 0.10000001"), "{fault}");
        assert!(fault.to_string().contains("more than the crank's radius by a thousandth"), "{fault}");
        assert!(parse_train("press", &text(0.1001, pins)).is_ok());
    }
}

/// A crank that its pins hold is refused at them, and what would free it is named.
#[test]
fn pins_that_jam_are_refused_at_their_table() {
    let crank = "inertia = 0.01\nspeed = 20.0\n[coordinate.crank]\nradius = 0.08\nrod = 0.3\nslider_mass = 80.0\n\
                 [coordinate.crank.pins]\ncoefficient = 0.5\nmain = 0.07\n";
    let text = press(crank, "force = 1.0\n");
    let fault = parse_train("press", &text).unwrap_err();
    assert_eq!(text.lines().nth(fault.line - 1), Some("[coordinate.crank.pins]"), "{fault}");
    assert!(fault.to_string().contains("smaller radii, a lighter slider or more inertia"), "{fault}");
    assert!(parse_train("press", &text.replace("inertia = 0.01", "inertia = 2.0")).is_ok());
}

/// The pins of a four-bar are those of a train built by hand, with the friction of the rocker as a load, and are
/// refused where they jam.
#[test]
fn the_pins_of_a_four_bar_are_those_of_a_train_by_hand() {
    let bars = "inertia = 0.2\nspeed = 20.0\n[coordinate.four_bar]\ncrank = 0.1\ncoupler = 0.35\nrocker = 0.3\n\
                ground = 0.4\nrocker_inertia = 2.5\nfriction = 1.0\n";
    let text = |pins: &str| press(&(bars.to_owned() + pins), "force = 3.0\n").replace("cycle = \"crank\"\n", "");
    let table = "[coordinate.four_bar.pins]\ncoefficient = 0.1\nmain = 0.04\ncrank = 0.03\nrocker = 0.02\n\
                 pivot = 0.025\n";
    let file = parse_train("press", &text(table)).unwrap();
    let bars = FourBar { crank: 0.1, coupler: 0.35, rocker: 0.3, ground: 0.4 };
    let pins = FourBarPins { coefficient: 0.1, main: 0.04, crank: 0.03, rocker: 0.02, pivot: 0.025 };
    // with the coupler stretched out its pin is furthest from the crank, so that the rocker's angle is least, and rises
    // until the coupler is folded back
    let [stretched, folded] = bars.dead_centres();
    let load = |load, from, to| StrokeLoad { load, from, to };
    let loads = [load(-1.0, stretched, folded), load(1.0, folded, stretched + TAU), load(3.0, 0.0, TAU)];
    let rocker = Orders::sampled(|angle| bars.angles(angle)[1]);
    let crank = Coordinate::new(0.2)
        .speed(20.0)
        .inertia_law(Orders::inertia(&[(2.5, &rocker)]))
        .four_bar_pins(bars, 2.5, pins, &loads);
    let crank = rubbing(&rocker, 1.0).into_iter().fold(crank, Coordinate::source);
    let by_hand = Train::new().coordinate(crank.source(Source::Orders(rocker.slope().times(3.0).0)));
    assert!(file.train == by_hand, "{:?}\n{by_hand:?}", file.train);
    // once, though its pins and its friction both keep it from turning backwards
    let forwards = |text: &str| parse_train("press", text).unwrap().forwards;
    let smooth = |pins: &str| text(pins).replace("friction = 1.0\n", "");
    assert_eq!([forwards(&text(table)), forwards(&text("")), forwards(&smooth(table))], [[0], [0], [0]]);
    assert!(forwards(&smooth("")).is_empty());
    let jammed = text(&table.replace("0.04", "0.9").replace("= 0.1\n", "= 1.0\n"));
    let fault = parse_train("press", &jammed).err().unwrap();
    assert_eq!(jammed.lines().nth(fault.line - 1), Some("[coordinate.four_bar.pins]"), "{fault}");
    assert!(fault.to_string().contains("less inertia of the rocker or more of the crank"), "{fault}");
    let result = answered("simulate", &text(table));
    assert!(!result["proof"].is_null(), "{result}");
    let mut motion = by_hand.build().unwrap();
    motion.advance(1.0);
    let last = result["coordinates"][0]["last"].as_f64().unwrap();
    // roundings of a hundred steps
    assert!((last / motion.speed(0) - 1.0).abs() < 1e-11, "{last} {}", motion.speed(0));
}

/// Friction against a surface that moves, on a mechanism's coordinate: refused at the friction, not at the coordinate.
#[test]
fn friction_on_a_moving_surface_is_refused_at_its_table() {
    let crank = "inertia = 2.0\nspeed = 20.0\n[coordinate.crank]\nradius = 0.08\nrod = 0.3\nslider_mass = 8.0\n";
    let text = press(crank, "force = 1.0\n") + "[[friction]]\non = \"crank\"\ntorque = 4.0\nsurface = 2.0\n";
    let fault = parse_train("press", &text).unwrap_err();
    assert!(fault.found.contains("on \"crank\", whose inertia changes with its angle"), "{fault}");
    assert_eq!(text.lines().nth(fault.line - 1), Some("[[friction]]"), "{fault}");
    // against the ground at rest it runs
    assert!(parse_train("press", &text.replace("surface = 2.0\n", "")).is_ok());
}

/// Elements turn; of its own coordinates a file does not say which are ways.
#[test]
fn the_tables_have_the_units_that_the_file_leaves_open() {
    let bench = Bench::with("step.toml", STEP);
    let elements = bench.said(&["simulate", &machine("hoist-start")]);
    assert!(elements.contains("least N m ") && elements.contains("least rad/s ") && !elements.contains(" or N"));
    let own = bench.said(&["simulate", "step.toml"]);
    assert!(own.contains("least N m or N ") && own.contains("least rad or m ") && own.contains("least rad/s or m/s "));
}

/// A clutch between two masses slips until they turn alike: the energy lost is `J1 J2/(J1 + J2) (w1 - w2)^2/2`, the way
/// `(w1 - w2)^2/(2 T (1/J1 + 1/J2))`.
#[test]
fn the_heat_of_a_slip_clutch_is_the_energy_that_is_lost() {
    for k in 0..20 {
        let [one, other, torque] = [0.1 * 1.4_f64.powi(k), 20.0 / 1.3_f64.powi(k), 3.0 * 1.2_f64.powi(k)];
        let [fast, slow] = [100.0 - f64::from(k), f64::from(k % 3) - 1.0];
        let (reduced, slip) = (one * other / (one + other), fast - slow);
        let time = 1.25 * reduced * slip / torque;
        let text = format!(
            "name = \"clutch\"\n[[coordinate]]\nname = \"motor\"\ninertia = {one:?}\nspeed = {fast:?}\n\
             [[coordinate]]\nname = \"load\"\ninertia = {other:?}\nspeed = {slow:?}\n\
             [[friction]]\nbetween = [\"motor\", \"load\"]\ntorque = {torque:?}\n\
             [run]\ntime = {time:?}\nstep = {:?}\n",
            time / 50.0
        );
        let clutch = &answered("simulate", &text)["frictions"][0];
        assert_eq!(clutch["name"], "motor on load");
        let close = |key: &str, expected: f64, within: f64| {
            let found = clutch[key].as_f64().unwrap();
            assert!((found - expected).abs() <= within * expected, "machine {k}, {key}: {found} {expected}");
        };
        // rounding of the angles; the slip ends at a line of the run
        close("heat", 0.5 * reduced * slip * slip, 1e-11);
        close("slid", 0.5 * reduced * slip * slip / torque, 1e-11);
        // over the first fiftieth the slip falls by a fortieth
        close("power", torque * slip * (1.0 - 0.5 / 40.0), 1e-11);
    }
}

/// By fractions from the constants of the standard, which itself gives about 14 N/(mm um) for a pair.
#[test]
fn the_mesh_of_tooth_data_is_that_of_the_standard() {
    let mesh = |keys: &str| {
        let text = std::fs::read_to_string(machine("torques")).unwrap();
        text.replace("face_width = 0.03\ntooth_numbers = [21, 50]\n\n", &format!("{keys}\n"))
    };
    let read = |text: &str| parse_train("torques", text).map(|file| format!("{:?}", file.train));
    for (data, pair) in [
        ("tooth_numbers = [21, 50]", 13.379394553726314),
        ("tooth_numbers = [17, 103]\nshift = [0.4, -0.1]", 14.574087341789637),
    ] {
        let data = mesh(&format!("face_width = 1.0\n{data}\n"));
        let lines: Vec<String> = read(&data).unwrap().split("single: ").map(str::to_owned).collect();
        let single: f64 = lines[1].split(',').next().unwrap().parse().unwrap();
        let double: f64 = lines[0].rsplit("double: ").next().unwrap().split(',').next().unwrap().parse().unwrap();
        assert!((single / (1e9 * pair) - 1.0).abs() < 1e-14, "{single} {pair}");
        // 0.75 x 1.6 + 0.25 of one pair in the mean, two of them in contact for 0.6 of the mesh
        assert!(((0.6 * double + 0.4 * single) / single - 1.45).abs() < 1e-14, "{double} {single}");
    }
    for wrong in ["shift = [0.1, 0.4]", "shift = [-0.4, -0.5]", "shift = [0.1]", "double = 1e8"] {
        let fault = read(&mesh(&format!("face_width = 1.0\ntooth_numbers = [21, 50]\n{wrong}\n"))).unwrap_err();
        assert_eq!(fault.key.rsplit('.').next(), wrong.split(' ').next(), "{fault:?}");
    }
}
