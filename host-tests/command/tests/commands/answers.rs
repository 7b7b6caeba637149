//! One machine file, the same answer from every command that reads it.

use std::fs;
use std::path::Path;
use std::process::Command;

use cargo_driveline::cli::Plan;
use cargo_driveline::machine_file::parse;

use super::bench::{Bench, answered};

const SETTINGS: &str = "[encoder]\nlines = 2048\n[control]\nrate_hz = 4000\n[disturbance]\ntorque_accuracy = 4.0\n\
    load_torque_step = 150.0\nwithin = 10.0\n[limits]\ntorque = 600.0\nrated_torque = 300.0\nspeed = 150.0\n";

fn element(kind: &str, rest: &str) -> String {
    format!("[[element]]\nkind = \"{kind}\"\n{rest}\n")
}

/// An element by its word: lower case for what loses nothing.
fn of(word: &str) -> String {
    match word {
        "M" => element("motor", "inertia = 0.5"),
        "K" => element("shaft", "stiffness = 2.0e4\ndamping = 3.0"),
        "k" => element("shaft", "stiffness = 4.0e6\ndamping = 500.0"),
        "d" => element("shaft", "stiffness = 2.0e5\ndamping = 30.0\ninertia = 0.4"),
        "r" => element("rotor", "inertia = 0.05"),
        "q" => element("rotor", "inertia = 3.0"),
        "R" => element("rotor", "inertia = 300.0"),
        "G" => element("gear", "ratio = 20.0\nefficiency = 0.94"),
        "g" => element("gear", "ratio = 20.0"),
        "H" => element("gear", "ratio = 2.0\nefficiency = 0.97"),
        "W" => element("worm", "ratio = 20.0\nefficiency = 0.8\nback_efficiency = 0.7"),
        "w" => element("worm", "ratio = 40.0\nefficiency = 0.4\nback_efficiency = -0.01"),
        "P" => element(
            "planetary",
            "sun_teeth = 20\nring_teeth = 90\nmodule = 0.004\nplanets = 3\nsun = 0.013\nplanet = 0.0027\n\
             planet_mass = 3.7\ncarrier = 0.067\nefficiency = 0.97",
        ),
        "B" => element("backlash", "gap = 0.002"),
        "C" => element("crank", "inertia = 2.0\nradius = 0.1\nrod = 0.4\nslider = 20.0"),
        "E" => element("belt", "driving = 0.2\ndriven = 0.4\nstiffness = 4.0e5\ndamping = 40.0\nefficiency = 0.96"),
        "s" => element("section", "length = 0.4\ndiameter = 0.03\ndensity = 7850.0"),
        "D" => element("drum", "diameter = 0.8"),
        "S" => element("rope", "falls = 2\nstiffness = 2.9e6\ndamping = 3.6e3"),
        "L" => element("lifted", "mass = 3000.0"),
        "T" => element("slack", "travel = 0.02"),
        // at the motor: R and K behind g, D behind g, H twice
        "R/g" => element("rotor", "inertia = 0.75"),
        "K/g" => element("shaft", "stiffness = 50.0\ndamping = 0.0075"),
        "D/g" => element("drum", "diameter = 0.04"),
        "HH" => element("gear", "ratio = 4.0\nefficiency = 0.9409"),
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
fn answer(bench: &Bench, arguments: &[&str]) -> (bool, String) {
    let ended = bench.run(arguments);
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

/// Machines with a lock, a heavy shaft, a shaft that the rate does not follow, a crank, a belt, a coupling before its
/// gear, a rope without a shaft, a slack one.
const ODD: [&str; 23] = [
    "M w K R",
    "M q w K R",
    "M K w R",
    "M K r w D L",
    "M d R",
    "M K q",
    "M q K q K q",
    "M w R",
    "M K C",
    "M K r H C",
    "M E q",
    "M K q E q",
    "M s q",
    "M k r G R",
    "M k H q",
    "M k H K q",
    "M D S L",
    "M K D S L",
    "M B K D S L",
    "M D T S L",
    "M G D T S L",
    "M K r G D T S L",
    "M K r G D S T L",
];

/// Changes of a file, and whether it is still a machine.
const CHANGED: [(&str, &str, bool); 9] = [
    ("[encoder]\nlines = 2048\n", "", false),
    ("[limits]", "[bounds]", false),
    ("rated_torque = 300.0", "rated_torque = 900.0", false),
    ("inertia = 3.0", "inertia = \"3 kg\"", false),
    ("stiffness = 2.0e4", "stiffness = \"2e4 N/m\"", false),
    ("ratio = 2.0", "ratio = 0.0", false),
    ("lines = 2048", "lines = 40", true),
    ("rate_hz = 4000", "rate_hz = 40", true),
    ("[limits]", "[tolerance]\nstiffness = 0.4\n[limits]", true),
];

/// Why a command makes no drive: what follows these words, without the place of the file.
fn cause(said: &str) -> Option<String> {
    let begins = ["no drive can be made: ", "the speed loop has no margins: ", "the speed loop lacks margins: "];
    let (_, why) = begins.into_iter().find_map(|words| said.split_once(words))?;
    let end = why.find(['\n', '"']).unwrap_or(why.len());
    Some(why[..end].trim_end_matches("; see `--help`").to_owned())
}

/// A recording that every observer takes: a slow swing of an angle.
fn recording() -> String {
    let row = |k: u32| format!("{},{},{}\n", f64::from(k) / 4000.0, (0.01 * f64::from(k)).sin(), 1e-3 * f64::from(k));
    format!("time [s],torque [N m],angle [rad]\n{}", (0..400).map(row).collect::<String>())
}

/// The first object of what was said; warnings may follow.
fn json(said: &str) -> serde_json::Value {
    serde_json::Deserializer::from_str(said).into_iter().next().unwrap().unwrap()
}

/// Eight commands, each with what it asks of a machine. What they refuse they refuse for the same reason in the same
/// words; what two of them print is the same figure.
///
/// The exports are refused for their place in the end, since compiling takes minutes.
#[test]
fn every_command_gives_the_same_answer() {
    let bench = &Bench::with("swing.csv", recording());
    fs::create_dir(bench.path("full")).unwrap();
    bench.write("full/mine", "kept");
    let run = "[run]\ntime = 0.02\nstep = 1e-3\n";
    let plain = WITH_A_SHAFT.iter().chain(&WITHOUT).chain(&ODD).map(|words| ((*words).to_owned(), file(words)));
    let base = file("M K q H q");
    let changed = CHANGED.iter().map(|(from, to, _)| {
        assert!(base.contains(from), "{from}");
        (format!("{from:?} {to:?}"), base.replacen(from, to, 1))
    });
    let (mut made, mut lacking, mut refused) = (0, 0, 0);
    for (index, (what, text)) in plain.chain(changed).enumerate() {
        bench.write("m.toml", &text);
        bench.write("run.toml", format!("{text}{run}"));
        let project = format!("p{index}");
        let design = answer(bench, &["design", "m.toml", "--json"]);
        let modes = answer(bench, &["modes", "m.toml", "--json"]);
        let new = answer(bench, &["new", &project, "--machine", "m.toml"]);
        let library = answer(bench, &["export", "c", "m.toml", "--core", "host", "--out", "full"]);
        let fmu = answer(bench, &["export", "fmu", "m.toml", "--out", "none/m.fmu"]);
        let campaign = answer(bench, &["campaign", "m.toml", "--draw", "0"]);
        let replay = answer(bench, &["replay", "swing.csv", "--machine", "m.toml", "--json"]);
        let simulate = answer(bench, &["simulate", "run.toml", "--json"]);
        let of_drive = [&design, &new, &library, &fmu, &campaign, &replay];
        let all = [&design, &modes, &new, &library, &fmu, &campaign, &replay, &simulate];
        let machine = match parse("m.toml", &text) {
            Ok(machine) => machine,
            Err(fault) => {
                let sentence = fault.to_string();
                let sentence = sentence.lines().next().unwrap().trim_start_matches("m.toml");
                let quoted = serde_json::to_string(sentence).unwrap();
                let same = |said: &str| said.contains(sentence) || said.contains(quoted.trim_matches('"'));
                // modes and a run need no settings of a drive
                let asked = if fault.found == "nothing" { &of_drive[..] } else { &all[..] };
                assert!(asked.iter().all(|(taken, said)| !taken && same(said)), "{what}: {sentence}: {all:?}");
                refused += 1;
                continue;
            }
        };
        let has_shaft = !machine.chain.shafts().is_empty();
        assert_eq!(machine.losses_of_no_chain().is_some(), !has_shaft && machine.chain.efficiency() < 1.0, "{what}");
        assert!(modes.0, "{what}: {}", modes.1);
        // a drive: the same cause, or none
        let why = cause(&new.1);
        assert_eq!(new.0, why.is_none(), "{what}: {}", new.1);
        for (name, (_, said)) in [("export c", &library), ("export fmu", &fmu)] {
            assert_eq!(cause(said), why, "{what}: {name}: {said}");
        }
        // without a shaft the design is that of one mass, of which there is no drive yet
        assert_eq!(cause(&design.1), why.clone().filter(|_| has_shaft), "{what}: {}", design.1);
        // what lacks margins can be drawn, with the same words; what cannot be designed cannot
        let lacks = why.is_some() && design.1.contains("margins: ");
        match &why {
            // a gear without a mass before it cannot lock in the solver, with a remedy that works
            _ if what == "M K w R" => {
                let remedy = campaign.1.split_once("put a `rotor` of ").unwrap().1.split(' ').next().unwrap();
                let rotor = element("rotor", &format!("inertia = {remedy}"));
                let text =
                    text.replacen("[[element]]\nkind = \"worm\"", &format!("{rotor}[[element]]\nkind = \"worm\""), 1);
                bench.write("m.toml", &text);
                bench.write("run.toml", format!("{text}{run}"));
                for again in [&["campaign", "m.toml", "--draw", "0"][..], &["simulate", "run.toml"]] {
                    let (taken, said) = answer(bench, again);
                    assert!(!campaign.0 && taken, "{what}: {said}");
                }
            }
            None => assert!(campaign.0 && !campaign.1.contains("warning: "), "{what}: {}", campaign.1),
            Some(why) if lacks => {
                assert!(campaign.0 && campaign.1.contains(why.as_str()), "{what}: {why}: {}", campaign.1);
            }
            Some(why) => assert!(cause(&campaign.1).as_ref() == Some(why), "{what}: {why}: {}", campaign.1),
        }
        // the observer alone, at the recording's rate
        assert!(replay.0, "{what}: {}", replay.1);
        // a gear without a mass before it cannot lock in the solver, one without a shaft has no place for its loss
        assert!(simulate.0 || !has_shaft || what == "M K w R", "{what}: {}", simulate.1);
        (made, lacking) = (made + u32::from(why.is_none()), lacking + u32::from(lacks));
        if has_shaft && why.is_none() {
            same_figures(&what, [&design.1, &modes.1], &bench.path(&project));
        }
    }
    // each kind of answer was there
    println!("{made} drives, {lacking} without margins, {refused} files with a fault");
    assert!(made > 25 && lacking > 2 && refused == CHANGED.iter().filter(|(.., sound)| !sound).count());
}

/// Masses, stiffness and resonances of `design` and `modes`; rated torque of a file and of its project.
fn same_figures(what: &str, said: [&String; 2], project: &Path) {
    let [design, modes] = said.map(|said| json(said));
    let shaft = &design["shaft"];
    let reduced = &modes["reductions"][0];
    let [motor, load] = [0, 1].map(|side| &design["inertias"][side]);
    assert_eq!([motor, load], [&reduced["motor_inertia"], &reduced["load_inertia"]], "{what}");
    assert_eq!([&shaft["stiffness"], &shaft["damping"]], [&reduced["stiffness"], &reduced["damping"]], "{what}");
    // two masses by hand; the frequencies of the exact modes beside the errors that are printed
    let value = |value: &serde_json::Value| value.as_f64().unwrap();
    let held = (value(&shaft["stiffness"]) / value(load)).sqrt();
    let free = held * (1.0 + value(load) / value(motor)).sqrt();
    // a few roundings
    let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-9;
    assert!(near(value(&shaft["resonance"]), free) && near(value(&shaft["antiresonance"]), held), "{what}: {shaft}");
    let mode = reduced["mode"].as_u64().unwrap() as usize - 1;
    let exact = value(&modes["resonances"][mode]["frequency"]) * (1.0 + value(&reduced["resonance_error"]));
    assert!(near(exact, free), "{what}: {exact} {free}");
    let rust = fs::read_to_string(project.join("src/machine.rs")).unwrap();
    assert!(
        rust.contains("Rating { torque: Torque(300.0), speed: Speed(150.0), torque_limit: Torque(600.0) }"),
        "{what}: {rust}"
    );
}

/// A machine in two files, once with all of it at the motor, has the same figures in a campaign: those of the machine as
/// it is, and those of a draw.
#[test]
fn a_campaign_of_one_machine_in_two_files_is_the_same() {
    let pairs = [
        ("M K g R", "M K R/g"),
        ("M g K R", "M K/g R/g"),
        ("M K H H q", "M K HH q"),
        ("M g D S L", "M D/g S L"),
        ("M g D T S L", "M D/g T S L"),
    ];
    let figures = |words: &str, of: &str| {
        let said = Bench::with("m.toml", file(words)).json(&["campaign", "m.toml", "--draw", "3"]);
        said[of].as_object().unwrap().clone()
    };
    for (words, at_motor) in pairs {
        for of in ["nominal", "figures"] {
            let (one, other) = (figures(words, of), figures(at_motor, of));
            assert!(one.len() > 10 && one.len() == other.len(), "{words} {of}: {one:?} {other:?}");
            for (name, value) in &one {
                let (a, b) = (value.as_f64(), other[name].as_f64());
                let near = a.zip(b).map_or(a == b, |(a, b)| (a - b).abs() <= 1e-3 * a.abs() + 1e-6);
                assert!(near, "{words} {of} {name}: {value} {}", other[name]);
            }
        }
    }
}

/// The kept mode is the one whose frequency the two masses have, by hand from what is printed.
#[test]
fn the_mode_that_is_kept_is_named() {
    let mut names = std::collections::BTreeSet::new();
    let branch = "[[branch]]\nat = \"rotor\"\n[[branch.element]]\nkind = \"shaft\"\nstiffness = 5.0\n\
        [[branch.element]]\nkind = \"rotor\"\ninertia = 1.0e-3\n[encoder]";
    for (words, branch) in
        [("M K q", "[encoder]"), ("M K q K q", "[encoder]"), ("M K r G k R", "[encoder]"), ("M K q", branch)]
    {
        let said = answered("modes", &file(words).replace("[encoder]", branch));
        let kept = &said["reductions"][1];
        let value = |name: &str| kept[name].as_f64().unwrap();
        let free = (value("stiffness") * (1.0 / value("motor_inertia") + 1.0 / value("load_inertia"))).sqrt();
        let all = said["resonances"].as_array().unwrap().iter().map(|one| one["frequency"].as_f64().unwrap());
        let mode = all.clone().position(|one| (free / one - 1.0).abs() < 1e-9).unwrap_or_else(|| panic!("{words}"));
        assert_eq!(kept["by"], format!("mode {} kept exactly", mode + 1), "{words}: {free} of {all:?}");
        assert!(value("resonance_error").abs() < 1e-9 && kept["mode"] == mode + 1, "{words}: {kept}");
        names.insert(mode);
    }
    // a light branch has the first mode, which the motor hardly sees
    assert_eq!(names.len(), 2, "{names:?}");
}

/// A remedy in words, put into the file, leaves nothing lacking. Less of every tolerance is in no machine here.
#[test]
fn a_remedy_of_the_design_works() {
    let remedies = [
        ("with `bandwidth = ", "` in `[speed_loop]` it has all margins"),
        ("with `within = ", "` in `[disturbance]`, a faster observer, it has all margins"),
    ];
    let mut tried = [0; 2];
    let lack = |text: &str| {
        let plan = Plan::with_dampers(&parse("m.toml", text).unwrap())?;
        Ok::<_, String>(plan.speed_loop.unwrap().not_robust)
    };
    for words in ["M K q", "M q K q", "M B K R", "M q K R", "M q K q K q", "M w K R"] {
        for (within, wide) in [(10.0, 0.3), (1.0, 0.6), (100.0, 0.2), (0.05, 0.9)] {
            for bandwidth in [0.05, 0.1, 0.4, 0.8] {
                let text = |bandwidth: &str, within: &str| {
                    let settings = file(words).replace("within = 10.0", &format!("within = {within}"));
                    let tolerance = format!("[tolerance]\nstiffness = {wide:?}\nload_inertia = {wide:?}\n");
                    format!("{settings}{tolerance}[speed_loop]\nbandwidth = {bandwidth}\n")
                };
                let told = [format!("{bandwidth:?}"), format!("{within:?}")];
                let Ok(Some(why)) = lack(&text(&told[0], &told[1])) else { continue };
                for (kind, (from, to)) in remedies.iter().enumerate() {
                    let Some(value) = why.split_once(from).and_then(|(_, rest)| rest.strip_suffix(to)) else {
                        continue;
                    };
                    let mended = if kind == 0 { text(value, &told[1]) } else { text(&told[0], value) };
                    assert_eq!(lack(&mended), Ok(None), "{words} {told:?}: {why}");
                    tried[kind] += 1;
                }
            }
        }
    }
    println!("tried {tried:?}");
    assert!(tried.iter().all(|&kind| kind > 0), "{tried:?}");
}

/// A rate at which no loop is stable is told with one at which it is.
#[test]
fn a_rate_that_is_too_low_is_told_with_one_that_is_not() {
    let at = |rate: &str| {
        let roll = include_str!("../../machines/roll.toml").replace("rate_hz = 10000", &format!("rate_hz = {rate}"));
        Plan::with_dampers(&parse("roll.toml", &roll).unwrap())
    };
    for rate in ["200", "500"] {
        let why = at(rate).unwrap_err();
        let (_, higher) = why.split_once("with `rate_hz = ").unwrap_or_else(|| panic!("{why}"));
        let plan = at(higher.split('`').next().unwrap()).unwrap();
        assert_eq!(plan.speed_loop.unwrap().not_robust, None, "{why}");
    }
}

/// The build script of a project, compiled and run as cargo does.
fn built(project: &Path) -> String {
    let script = project.join("script");
    let arguments = ["--edition", "2024", "build.rs", "-o", "script"];
    assert!(Command::new("rustc").args(arguments).current_dir(project).status().unwrap().success());
    let ended = Command::new(script).current_dir(project).output().unwrap();
    assert!(ended.status.success(), "{}", String::from_utf8_lossy(&ended.stderr));
    String::from_utf8(ended.stdout).unwrap()
}

/// A machine file that has changed stops the build until the remedy that is printed has been followed. What was there
/// is kept.
#[test]
fn data_and_constants_of_a_project_do_not_part() {
    let bench = Bench::with("m.toml", file("M K q H q"));
    let parts = ["--board", "qemu-m3", "--parts", "fluctuation"];
    bench.said(&[&["new", "mine", "--machine", "m.toml"], &parts[..]].concat());
    let project = bench.path("mine");
    let parted = |said: &str| said.contains("cargo::error=") || said.contains("cargo::warning=");
    assert!(!parted(&built(&project)));
    let read = |path: &str| fs::read_to_string(project.join(path)).unwrap();
    // by a formatter: the same
    let constants = read("src/machine.rs");
    fs::write(project.join("src/machine.rs"), constants.replace("    const", "\tconst").replace(" }", ", }")).unwrap();
    assert!(!parted(&built(&project)));
    // by hand: a warning
    fs::write(project.join("src/machine.rs"), constants.replace("Speed(150.0)", "Speed(140.0)")).unwrap();
    assert!(built(&project).contains("cargo::warning=src/machine.rs was changed by hand"));
    fs::write(project.join("src/machine.rs"), &constants).unwrap();
    // the data: an error, with the remedy
    fs::write(project.join("machine.toml"), file("M K q H q").replace("speed = 150.0", "speed = 130.0")).unwrap();
    let said = built(&project);
    let (_, remedy) = said.split_once("type `cargo driveline ").unwrap_or_else(|| panic!("{said}"));
    let remedy: Vec<&str> = remedy.split('`').next().unwrap().split(' ').collect();
    let lib = read("src/lib.rs");
    // in the project's folder
    let remedied = || {
        let mut command = Command::new(env!("CARGO_BIN_EXE_cargo-driveline"));
        let ended = command.args(&remedy).current_dir(&project).output().unwrap();
        (ended.status.success(), [ended.stdout, ended.stderr].map(|said| String::from_utf8(said).unwrap()).concat())
    };
    let mended = remedied();
    assert!(mended.0 && mended.1.contains("src/machine.rs.old"), "{}", mended.1);
    assert!(!parted(&built(&project)));
    assert!(read("src/machine.rs").contains("Speed(130.0)") && read("src/machine.rs.old") == constants);
    // nothing else of the options or the name
    assert_eq!(read("src/lib.rs"), lib);
    assert!(remedied().1.contains("nothing has changed"));
    // a copy is not written over
    fs::write(project.join("machine.toml"), file("M K q H q")).unwrap();
    let refused = remedied();
    assert!(!refused.0 && refused.1.contains("src/machine.rs.old would be written over"), "{}", refused.1);
    assert!(read("src/machine.rs").contains("Speed(130.0)"));
}
