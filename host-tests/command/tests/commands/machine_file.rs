//! Machine files: what is right is read, and what is wrong is told with its place, its key and what was expected.

use std::path::Path;

use cargo_driveline::machine_file::{Diagnostic, Element, MachineFile, parse, read};
use driveline::configure::Machine as _;
use driveline::design::{ClosedLoop, Disturbance, Error, Rate, SpeedLoopTuning};
use driveline::machine::{Length, Mass};
use driveline_firmware::scenes::hoist::Hoist;
use proptest::prelude::*;

use super::bench::Bench;

const HOIST: &str = include_str!("../../machines/hoist.toml");

fn hoist_with(from: &str, to: &str) -> Result<MachineFile, Diagnostic> {
    assert!(HOIST.contains(from), "{from}");
    parse("hoist.toml", &HOIST.replacen(from, to, 1))
}

/// The fault after replacing a piece of the hoist's file.
#[track_caller]
fn fault(from: &str, to: &str) -> Diagnostic {
    hoist_with(from, to).expect_err("the file should be refused")
}

#[test]
fn the_machines_of_the_repository_are_read() {
    let hoist = parse("hoist.toml", HOIST).unwrap();
    assert_eq!(hoist.elements.len(), 7);
    assert_eq!(hoist.elements[6].element, Element::Lifted { mass: 12_000.0 });
    assert_eq!(hoist.elements[2].label, "brake drum");
    assert_eq!(hoist.chain.masses().len(), 3);
    // The load at the motor: m (D/(2 i n))^2 [Wang 1989 §1-3].
    let travel = 0.8 / (2.0 * 31.5 * 2.0);
    assert!((hoist.chain.masses()[2] / (12_000.0 * travel * travel) - 1.0).abs() < 4.0 * f64::EPSILON);
    for entry in std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/machines")).unwrap() {
        read(&entry.unwrap().path()).unwrap();
    }
}

#[test]
fn the_file_and_the_scene_are_one_hoist() {
    let hoist = parse("hoist.toml", HOIST).unwrap();
    let chain = hoist.chain.lengths(Length(5.0), Length(12.0), Length(30.0));
    assert_eq!(chain.loads(Mass(500.0), Mass(13_000.0)), Hoist::<10_000>::CHAIN);
    assert_eq!(
        (hoist.limits.torque, hoist.limits.speed),
        (Hoist::<10_000>::RATING.torque_limit.0, Hoist::<10_000>::RATING.speed.0)
    );
    // the file's observer is for a livelier load: a change of three tenths of rated torque every 2 s
    let Disturbance { load_torque_step, within, .. } = Hoist::<10_000>::DISTURBANCE;
    assert_eq!((hoist.disturbance.load_torque_step, hoist.disturbance.within), (load_torque_step, within));
}

/// A class gives what the file does not state; a number is a deviation either way, a list a range.
#[test]
fn tolerances_are_those_of_the_class_with_the_files_in_their_place() {
    use driveline::design::{Spread, Tolerance};
    let with = |text: &str| hoist_with("[limits]", &format!("[tolerance]\n{text}\n[limits]"));
    let usual = parse("hoist.toml", HOIST).unwrap().tolerance();
    assert_eq!(usual, Tolerance { gap: Spread::NONE, ..Tolerance::USUAL });
    let mill = with("class = \"mill\"\nload = [0.05, 1.1]\nstiffness = 0.1").unwrap().tolerance();
    assert_eq!(mill.stiffness, Spread::within(0.1));
    // 20 % of the class beside the load
    assert!((mill.load_inertia.min - 0.04).abs() < 1e-15 && (mill.load_inertia.max - 1.32).abs() < 1e-15);
    // 200 Hz
    assert!((mill.lag * core::f64::consts::TAU * 200.0 - 1.0).abs() < 1e-15);
    for (text, key) in [
        ("class = \"boat\"", "tolerance.class"),
        ("stiffness = 2", "tolerance.stiffness"),
        ("load = [2, 1]", "tolerance.load"),
        ("jitter = \"none\"", "tolerance.jitter"),
        ("rope = 0.1", "tolerance.rope"),
        ("gap = 0.5", "tolerance.gap"),
    ] {
        assert_eq!(with(text).expect_err("it should be refused").key, key);
    }
}

#[test]
fn a_fault_names_place_key_found_and_expected() {
    let fault = fault("inertia = 0.08 ", "inertia = -0.08");
    let line = HOIST.lines().position(|line| line.starts_with("inertia = 0.08")).unwrap() + 1;
    assert_eq!((fault.line, fault.column), (line, 11));
    assert_eq!(fault.key, "element[2].inertia");
    assert_eq!(fault.found, "-0.08");
    assert_eq!(fault.expected, "a number, 1e-12 to 1e12 kg m²");
    let shown = fault.explained();
    assert!(shown.starts_with(&format!("hoist.toml:{line}:11: `element[2].inertia`: found -0.08, expected a number")));
    assert!(shown.contains(&format!("\n{line} | inertia = -0.08 ")), "{shown}");
    assert!(shown.lines().last().unwrap().ends_with("^^^^^"), "{shown}");
}

#[test]
fn absurd_values_are_refused_at_their_key() {
    let cases = [
        ("mass = 12000.0", "mass = nan", "element[6].mass", "nan"),
        ("mass = 12000.0", "mass = inf", "element[6].mass", "inf"),
        ("mass = 12000.0", "mass = 1e400", "element[6].mass", "1e400"),
        ("mass = 12000.0", "mass = 0", "element[6].mass", "0"),
        ("mass = 12000.0", "mass = \"heavy\"", "element[6].mass", "the text \"heavy\""),
        ("mass = 12000.0", "mass = true", "element[6].mass", "true"),
        ("mass = 12000.0", "mass = [1]", "element[6].mass", "a list"),
        ("mass = 12000.0", "mass = 1979-05-27", "element[6].mass", "the date 1979-05-27"),
        ("falls = 2", "falls = 2.5", "element[5].falls", "2.5"),
        ("falls = 2", "falls = 99999999999999999999999999", "element[5].falls", "99999999999999999999999999"),
        ("efficiency = 0.94", "efficiency = 1.1", "element[3].efficiency", "1.1"),
        ("damping = 2.0", "damping = -2.0", "element[1].damping", "-2.0"),
        ("lines = 2048", "lines = 0", "encoder.lines", "0"),
        ("rate_hz = 10000", "rate_hz = 1e9", "control.rate_hz", "1e9"),
        ("within = 50.0 ", "within = 0.0 ", "disturbance.within", "0.0"),
        ("speed = 155.0", "speed = -155.0", "limits.speed", "-155.0"),
        ("kind = \"gear\"", "kind = \"pulley\"", "element[3].kind", "the text \"pulley\""),
        ("name = \"hoist\"", "name = \"../../etc\"", "name", "the text \"../../etc\""),
        ("label = \"load\"", "label = \"\"", "element[6].label", "the text \"\""),
    ];
    for (from, to, key, found) in cases {
        let fault = fault(from, to);
        assert_eq!((fault.key.as_str(), fault.found.as_str()), (key, found), "{to}");
        let line = HOIST.replacen(from, to, 1).lines().position(|line| line.contains(to)).unwrap() + 1;
        assert_eq!(fault.line, line, "{to}");
    }
}

#[test]
fn a_rated_torque_is_not_above_the_largest() {
    let fault = fault("torque = 1350.0 ", "rated_torque = 1400.0\ntorque = 1350.0 ");
    assert_eq!((fault.key.as_str(), fault.found.as_str()), ("limits.rated_torque", "1400.0"));
    assert_eq!(fault.expected, "at most `limits.torque`, 1350 N m");
}

/// The hoist has 10 kHz, so that the speed loop's twelve ticks are 1.2 ms.
#[test]
fn an_actuator_that_no_drive_has_is_refused_at_its_key() {
    let limits = "[limits]";
    let with = |key: &str| format!("[actuator]\n{key}\n\n{limits}");
    for (key, name, expected) in [
        ("delay = 1e12", "actuator.delay", "a number, zero or 1e-12 to 1 s"),
        ("delay = 0.00121", "actuator.delay", "at most 12 ticks of `control.rate_hz`, 0.00120 s"),
        ("bandwidth = 0.05", "actuator.bandwidth", "a number, 0.1 to 1e12 Hz"),
    ] {
        let fault = fault(limits, &with(key));
        assert_eq!((fault.key.as_str(), fault.expected.as_str()), (name, expected));
    }
    // the last that is read is one that the design takes: whether its loop is stable is another question
    let machine = hoist_with(limits, &with("delay = 0.0012")).unwrap();
    let two = machine.two_masses().unwrap();
    let (_, encoder, disturbance) = machine.tuning();
    let rate = Rate::every(1e-4);
    let observer = two.try_observer(rate, encoder, disturbance).unwrap();
    let speed_loop = two.try_speed_loop(rate, SpeedLoopTuning::USUAL).unwrap();
    assert!(!matches!(ClosedLoop::of(&observer, &speed_loop, machine.actuator()), Err(Error::Actuator)));
}

#[test]
fn missing_and_unknown_keys_are_named() {
    let missing = fault("diameter = 0.8", "");
    assert_eq!((missing.key.as_str(), missing.found.as_str()), ("element[4].diameter", "nothing"));
    assert!(missing.expected.contains("`diameter`") && missing.expected.ends_with(" m"));
    let heading = HOIST.lines().enumerate().filter(|(_, line)| *line == "[[element]]").nth(4).unwrap().0 + 1;
    assert_eq!(missing.line, heading);

    let unknown = fault("diameter = 0.8", "diameter = 0.8\nradius = 0.4");
    assert_eq!((unknown.key.as_str(), unknown.found.as_str()), ("element[4].radius", "an unknown key"));
    assert_eq!(unknown.expected, "only `label`, `kind`, `diameter`");

    let late = fault("name = \"hoist\"", "[actuator]\ndelay = 1e-4\nname = \"hoist\"");
    assert_eq!((late.key.as_str(), late.found.as_str()), ("actuator.name", "an unknown key"));
    assert!(late.expected.ends_with("the file's own `name` is its first line"), "{late:?}");

    assert_eq!(fault("[encoder]\nlines = 2048", "").key, "encoder");
    assert_eq!(fault("name = \"hoist\"", "name = \"hoist\"\nowner = \"me\"").key, "owner");
}

/// Without its folder and extension; a character that no name has becomes `-`.
#[test]
fn a_machine_without_a_name_has_that_of_its_file() {
    let text = HOIST.replacen("name = \"hoist\"", "", 1);
    for (file, name) in [("files/north hoist.toml", "north hoist"), ("hoist.v2.toml", "hoist-v2"), ("stdin", "stdin")] {
        assert_eq!(parse(file, &text).unwrap().name, name);
    }
    assert_eq!(parse(&format!("{}.toml", "a".repeat(60)), &text).unwrap().name, "a".repeat(40));
    let none = parse("µ.toml", &text).unwrap_err();
    assert_eq!((none.key.as_str(), none.found.as_str()), ("name", "nothing"));
}

/// A key that the reader looks for more than once is named once.
#[test]
fn an_unknown_key_is_told_each_known_one_once() {
    let machine = fault("name = \"hoist\"", "name = \"hoist\"\nowner = \"me\"");
    let amplitudes = "name = \"fan\"\nunit = \"mm/s\"\nplanes = [\"A\"]\nowner = \"me\"\n\
                      [amplitudes]\nbaseline = 4.0\nweight = 1.0\nruns = [[0, 3.0], [120, 5.0], [240, 4.5]]\n";
    let balance = cargo_driveline::machine_file::balance::parse("fan.toml", amplitudes).unwrap_err();
    for fault in [machine, balance] {
        assert_eq!(fault.key, "owner", "{fault}");
        let mut keys: Vec<&str> = fault.expected.trim_start_matches("only ").split(", ").collect();
        let count = keys.len();
        keys.sort_unstable();
        keys.dedup();
        assert_eq!(keys.len(), count, "{fault}");
    }
}

#[test]
fn an_impossible_order_is_told_at_the_element() {
    let twice = fault("kind = \"rotor\"", "kind = \"motor\"");
    assert_eq!((twice.key.as_str(), twice.found.as_str()), ("element[2]", "a second motor"));
    let early = fault("kind = \"motor\"", "kind = \"rotor\"");
    assert_eq!((early.key.as_str(), early.found.as_str()), ("element[0]", "a rotor before the motor"));
    let after = fault("kind = \"lifted\"\nlabel = \"load\"\nmass = 12000.0", "kind = \"rotor\"\ninertia = 1.0");
    assert_eq!(after.key, "element[6]");
    assert!(after.found.starts_with("a rotor that cannot stand here ("), "{}", after.found);
    let open = fault("[[element]]\nkind = \"lifted\"\nlabel = \"load\"\nmass = 12000.0", "");
    assert_eq!(open.key, "element[5]");
    assert!(open.found.starts_with("a chain that ends in a rope ("), "{}", open.found);
    let element = "[[element]]\nkind = \"shaft\"\nstiffness = 1e4\n[[element]]\nkind = \"rotor\"\ninertia = 1.0\n";
    let long = fault("[[element]]\nkind = \"gear\"", &format!("{}[[element]]\nkind = \"gear\"", element.repeat(20)));
    assert!(long.found.contains("at most 16 masses"), "{}", long.found);
}

#[test]
fn what_is_no_toml_is_told_with_its_place() {
    let broken = fault("mass = 12000.0", "mass = 12,000.0");
    assert_eq!((&*broken.key, &*broken.found), ("mass", "`,000.0`"));
    assert_eq!(broken.expected, "a number without commas, its decimal sign a point");
    for (value, found) in [("12000.0 kg", "`12000.0 kg`"), ("n5", "`n5`"), ("five", "`five`"), (".5", "`.5`")] {
        let broken = fault("mass = 12000.0", &format!("mass = {value}"));
        assert_eq!(broken.found, found);
        assert!(broken.expected.starts_with("a number as 0.5 or 5e3 without its unit"), "{broken}");
    }
    let open = fault("mass = 12000.0", "mass = [12000.0");
    assert!(open.expected.starts_with("TOML ("), "{open}");
    let twice = fault("mass = 12000.0", "mass = 1.0\nmass = 2.0");
    assert!(twice.to_string().contains("duplicate key"), "{twice}");
    assert_eq!(parse("empty.toml", " \n").unwrap_err().found, "an empty file");
    let balancing = cargo_driveline::machine_file::balance::parse("empty.toml", "").unwrap_err();
    assert_eq!(balancing.found, "an empty file");
    let unnamed = HOIST.lines().filter(|line| !line.starts_with("name = \"hoist\"")).collect::<Vec<_>>().join("\n");
    assert!(parse("日本.toml", &unnamed).unwrap_err().expected.ends_with("as the file's own name has none of these"));
    assert_eq!(parse("no.toml", "element = []\nname = \"x\"").unwrap_err().found, "an empty list");
    assert_eq!(parse("no.toml", "element = 3\nname = \"x\"").unwrap_err().key, "element");
    assert_eq!(parse("no.toml", "element = [3]\nname = \"x\"").unwrap_err().key, "element[0]");
    let deep = format!("name = {}1{}", "[".repeat(100_000), "]".repeat(100_000));
    parse("deep.toml", &deep).unwrap_err();
}

#[test]
fn files_that_are_none_are_refused() {
    let refuse = |name: &str, bytes: &[u8]| read(&Bench::with(name, bytes).path(name)).unwrap_err();
    let binary = refuse("binary.toml", b"name = 1\n\xff\xfe\0garbage");
    assert_eq!((binary.line, binary.column), (2, 1));
    assert_eq!(binary.found, "the byte 0xff, which is not UTF-8");
    assert_eq!(refuse("huge.toml", &vec![b'#'; 2 << 20]).found, "more than 1 MiB");
    assert_eq!(refuse("empty.toml", b"").found, "an empty file");
    assert!(read(Path::new(env!("CARGO_TARGET_TMPDIR"))).unwrap_err().found.starts_with("no readable file ("));
    assert!(read(Path::new("nowhere/no.toml")).unwrap_err().found.starts_with("no readable file ("));
}

proptest! {
    /// Whatever is put into, cut out of or moved about in a machine file, reading it ends in a machine or a fault with
    /// a place within the text.
    #[test]
    fn mangled_files_never_panic(
        cuts in prop::collection::vec((0usize..HOIST.len(), 0usize..40, "[\\PC\\n\"\\[\\]=.#e0-9-]{0,6}"), 1..6)
    ) {
        let mut text = HOIST.to_owned();
        for (start, length, put) in cuts {
            let floor = |at: usize| (0..=at.min(text.len())).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0);
            let (from, to) = (floor(start), floor(start + length));
            text.replace_range(from..to, &put);
        }
        if let Err(fault) = parse("mangled.toml", &text) {
            prop_assert!(fault.line >= 1 && fault.line <= text.matches('\n').count() + 1, "{fault}");
            prop_assert!(!fault.found.is_empty() && !fault.expected.is_empty());
            prop_assert!(fault.explained().lines().all(|line| line.chars().count() < 700));
        }
    }

    /// Any bytes at all.
    #[test]
    fn garbage_never_panics(text in "\\PC{0,200}") {
        prop_assert!(parse("garbage.toml", &text).is_err());
    }

    /// A number survives the way from the file through the emitted Rust, to the bit.
    #[test]
    fn numbers_are_exact(inertia in 1e-12f64..1e12) {
        let machine = hoist_with("inertia = 0.62 ", &format!("inertia = {inertia:?} ")).unwrap();
        prop_assert_eq!(machine.elements[0].element, Element::Motor { inertia, viscous: 0.0 });
        let words = machine.elements[0].element.rust();
        prop_assert_eq!(words, format!("Chain::motor(Inertia({inertia:?}))"));
    }
}
