//! The FMUs of the hoist: their descriptions against FMI 3.0, and their closed loop against the host's own, to the bit.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use driveline::configure::{Configure, Machine};
use driveline::drive::{ConfigOf, Drive};
use driveline::governor::SpeedLoop;
use driveline::observer::{GearedObserver, SemiImplicitObserver};
use driveline::sample::Sample;
use driveline_solver::plant::train::{Coordinate, Link, Source, Train};
use driveline_solver::plant::{Chain, Plant, Shaft, Start};
use tempfile::TempDir;
use zip::ZipArchive;

use super::export::ended_well;
use super::export::hoist::Hoist;

type HoistDrive = Drive<f32, GearedObserver<SemiImplicitObserver>, SpeedLoop>;

pub const MACHINE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../command/machines/hoist.toml");

fn export(arguments: &[&str], out: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lab"));
    command.arg("export").args(arguments).arg("--out").arg(out).output().unwrap()
}

/// An element of XML without its content: name and attributes.
struct Element {
    name: String,
    attributes: BTreeMap<String, String>,
}

impl Element {
    fn get(&self, key: &str) -> &str {
        self.attributes.get(key).map_or("", String::as_str)
    }
}

/// An FMU, unpacked.
struct Fmu {
    folder: TempDir,
    elements: Vec<Element>,
}

impl Fmu {
    fn new(machine: &str, of: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("one.fmu");
        ended_well(&export(&["fmu", machine, "--of", of], &file));
        ZipArchive::new(File::open(file).unwrap()).unwrap().extract(folder.path()).unwrap();
        let text = fs::read_to_string(folder.path().join("modelDescription.xml")).unwrap();
        // no text holds a bracket or a quote
        let element = |tag: &str| {
            let (name, mut rest) = tag.split_once(char::is_whitespace).unwrap_or((tag, ""));
            let mut attributes = BTreeMap::new();
            while let Some((key, after)) = rest.split_once("=\"") {
                let (value, after) = after.split_once('"').unwrap();
                attributes.insert(key.trim().to_owned(), value.to_owned());
                rest = after;
            }
            Element { name: name.to_owned(), attributes }
        };
        let tags = text.split('<').skip(1).map(|tag| tag.split('>').next().unwrap().trim_end_matches('/'));
        Fmu { folder, elements: tags.map(element).collect() }
    }

    fn file(&self) -> PathBuf {
        self.folder.path().join("one.fmu")
    }

    fn elements<'f>(&'f self, name: &'f str) -> impl Iterator<Item = &'f Element> {
        self.elements.iter().filter(move |element| element.name == name)
    }

    fn variables(&self) -> impl Iterator<Item = &Element> {
        self.elements.iter().filter(|element| ["Float64", "UInt32", "Boolean"].contains(&&*element.name))
    }

    fn start(&self, name: &str) -> f64 {
        let of = self.variables().find(|variable| variable.get("name") == name);
        of.unwrap_or_else(|| panic!("no {name}")).get("start").parse().unwrap()
    }

    /// Library, token, and a file of the variables of type `Float64` with their starts.
    fn arguments(&self) -> [PathBuf; 3] {
        let model = self.elements("CoSimulation").next().unwrap().get("modelIdentifier");
        let library = self.folder.path().join(format!("binaries/{}-linux/{model}.so", std::env::consts::ARCH));
        let starts = self.elements("Float64").map(|variable| {
            let start = Some(variable.get("start")).filter(|start| !start.is_empty()).unwrap_or("nan");
            format!("{} {start}\n", variable.get("valueReference"))
        });
        let file = self.folder.path().join("starts");
        fs::write(&file, starts.collect::<String>()).unwrap();
        [library, self.elements("fmiModelDescription").next().unwrap().get("instantiationToken").into(), file]
    }
}

/// The rules of FMI 3.0 (2.4) that a schema cannot say, and the parts that it wants.
#[track_caller]
fn is_described_as_the_standard_wants(fmu: &Fmu) {
    let root = fmu.elements("fmiModelDescription").next().unwrap();
    assert_eq!(root.get("fmiVersion"), "3.0");
    let token = root.get("instantiationToken");
    assert!(token.len() == 32 && token.bytes().all(|c| c.is_ascii_hexdigit()), "{token}");
    let units: BTreeSet<&str> = fmu.elements("Unit").map(|unit| unit.get("name")).collect();
    let (mut names, mut references) = (BTreeSet::new(), BTreeSet::new());
    let mut outputs = Vec::new();
    for variable in fmu.variables() {
        let [name, reference, causality, variability] =
            ["name", "valueReference", "causality", "variability"].map(|key| variable.get(key));
        assert!(names.insert(name), "{name} is there twice");
        assert!(references.insert(reference), "{name} has the reference of another variable");
        assert!(!variable.get("description").is_empty(), "{name} has no description");
        let is_float = variable.name == "Float64";
        assert!(!is_float || units.contains(variable.get("unit")), "{name} has no unit");
        assert!(is_float || variability == "discrete", "{name} is {variability}");
        let has_start = !variable.get("start").is_empty();
        match (causality, variability, variable.get("initial")) {
            ("independent", "continuous", "") => assert!(!has_start && name == "time", "{name}"),
            ("input", "continuous" | "discrete", "")
            | ("parameter", "fixed" | "tunable", "")
            | ("local", "constant", "") => assert!(has_start, "{name} has no start"),
            ("output", "continuous" | "discrete", "calculated") => {
                assert!(!has_start, "{name} is calculated and has a start");
                outputs.push(reference);
            }
            other => panic!("{name}: {other:?} is no combination of the standard's"),
        }
    }
    assert!(names.contains("time"));
    for kind in ["Output", "InitialUnknown"] {
        let listed: Vec<&str> = fmu.elements(kind).map(|unknown| unknown.get("valueReference")).collect();
        assert_eq!(listed, outputs, "{kind}");
        for known in fmu.elements(kind).flat_map(|unknown| unknown.get("dependencies").split_whitespace()) {
            assert!(references.contains(known), "{kind} depends on {known}");
        }
    }
}

/// The loop of `loop.c` with the drive and the solver called from Rust.
fn on_the_host(mut plant: Plant, weight: f64) -> Vec<[f64; 13]> {
    let config: ConfigOf<HoistDrive> = <HoistDrive as Configure<Hoist, f32>>::CONFIG;
    // as the encoder counts it
    let counted = |angle: f64| ((angle / TAU * 8192.0).floor() as i64 as u32) << 19;
    let mut drive = HoistDrive::new(&config, 0);
    drive.hold(&config, 0, weight as f32);
    let mut torque = weight as f32;
    let row = |tick: usize| {
        let setpoint = if tick < 25_000 { 100.0 } else { 60.0 };
        let command = drive.tick(&config, &Sample { angle: counted(plant.motor_angle()), torque, setpoint });
        torque = command.torque;
        plant.set_load_torque(2, if tick < 20_000 { 747.0 } else { 1000.0 });
        plant.advance(torque.into(), 1e-4);
        let found = drive.estimate(&config);
        let estimates = [torque, found.motor_speed, found.shaft_torque, found.load_speed, found.load_torque];
        let [torque, motor_speed, shaft_torque, load_speed, load_torque] = estimates.map(f64::from);
        let angle = plant.motor_angle();
        let encoder = (angle / TAU * 8192.0).floor() / 8192.0 * TAU;
        let [shaft, rope] = [0, 1].map(|shaft| plant.torque_behind_gear(shaft));
        [
            torque,
            motor_speed,
            shaft_torque,
            load_speed,
            load_torque,
            command.faults.bits().into(),
            angle,
            encoder,
            plant.motor_speed(),
            plant.speed(2),
            torque,
            shaft,
            rope,
        ]
    };
    (0..30_000).map(row).collect()
}

/// Every wrong call, saving and restoring are in `loop.c`.
#[test]
fn the_fmus_in_closed_loop_give_the_bits_of_the_host() {
    let [controller, plant] = ["controller", "plant"].map(|of| Fmu::new(MACHINE, of));
    [&controller, &plant].into_iter().for_each(is_described_as_the_standard_wants);
    // the machine of the plant is that of the file, referred to the motor by the library
    let chain = Hoist::CHAIN;
    let of = |name: &str, at: usize| plant.start(&format!("{name}[{at}]"));
    assert_eq!([1, 2, 3].map(|at| of("inertia", at)), chain.masses()[..]);
    let shafts = chain.shafts().iter().map(|shaft| [shaft.stiffness, shaft.damping, shaft.gap]);
    let described = [1, 2].map(|at| ["stiffness", "damping", "gap"].map(|name| of(name, at)));
    assert_eq!(shafts.collect::<Vec<_>>(), described);
    assert_eq!(of("efficiency", 1) * of("efficiency", 2), chain.efficiency());
    let weight = plant.start("load_torque");
    assert_eq!([weight, controller.start("holding_torque")], [chain.gravity_torque(); 2]);

    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("loop");
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/images/fmu/loop.c");
    // `-rdynamic`: the libraries' allocations are counted by the program
    let flags = ["-std=gnu11", "-Wall", "-Wextra", "-Werror", "-O1", "-rdynamic", source, "-o"];
    ended_well(&Command::new("cc").args(flags).arg(&program).args(["-ldl", "-lm"]).output().unwrap());
    let mut run = Command::new(&program);
    run.args(controller.arguments()).args(plant.arguments()).current_dir(folder.path());
    let ended = run.output().unwrap();
    ended_well(&ended);
    println!("{}", String::from_utf8_lossy(&ended.stdout).trim_end());

    let shaft = |shaft: fn(f64) -> Shaft, at| shaft(of("stiffness", at)).damping(of("damping", at));
    let host = Chain::motor(of("inertia", 1))
        .shaft(shaft(Shaft::elastic, 1), of("inertia", 2))
        .efficiency(of("efficiency", 2))
        .shaft(shaft(Shaft::rope, 2), of("inertia", 3))
        .load(weight)
        .start(Start::Pretensioned { speed: 0.0 });
    let expected = on_the_host(host.build().unwrap(), weight);
    super::cosim::has_the_bits_of_the_host(&plant.file(), &expected);
    super::cosim::a_machine_of_another_tool_turns(&controller.file());
    let bytes = fs::read(folder.path().join("output")).unwrap();
    let rows: Vec<&[u8]> = bytes.chunks_exact(13 * 8).collect();
    assert_eq!(rows.len(), expected.len());
    for (tick, (row, expected)) in rows.iter().zip(&expected).enumerate() {
        let found: Vec<u64> = row.chunks_exact(8).map(|value| u64::from_le_bytes(value.try_into().unwrap())).collect();
        assert_eq!(found, expected.map(f64::to_bits), "tick {tick}: {expected:?}");
    }
    // the machine runs: 2 % are for what is left of the settling
    let settled = expected[19_999];
    assert!((settled[8] - 100.0).abs() < 2.0 && settled[5] == 0.0, "{settled:?}");
}

/// The hoist with a ring on its motor, in closed loop: the plant is the train with the ring as a coordinate more.
#[test]
fn a_plants_damper_is_a_further_mass() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("hoist.toml");
    let ring = "[[damper]]\nat = \"motor\"\nkind = \"tuned\"\ninertia = 0.05\nstiffness = 2000.0\ndamping = 1.5\n";
    fs::write(&file, format!("{}\n{ring}", fs::read_to_string(MACHINE).unwrap())).unwrap();
    let plant = Fmu::new(file.to_str().unwrap(), "plant");
    is_described_as_the_standard_wants(&plant);
    let chain = Hoist::CHAIN;
    let of = |name: &str, at: usize| plant.start(&format!("{name}[{at}]"));
    assert_eq!([of("inertia", 4), of("stiffness", 3), of("damping", 3), of("gap", 3)], [0.05, 2000.0, 1.5, 0.0]);
    let weight = chain.gravity_torque();
    let table = super::cosim::run(&file, &plant.file(), &["--setpoint", "100", "--time", "0.5"]);
    let [torque, angle, speed] = ["drive.torque_setpoint", "machine.motor_angle", "machine.load_speed"]
        .map(|name| super::cosim::column(&table, name));
    let [shaft, rope] = [0, 1].map(|at| chain.shafts()[at]);
    let train = chain.masses().iter().chain(&[0.05]).fold(Train::new(), |train, inertia| {
        let bare = Coordinate::new(*inertia);
        train.coordinate(bare)
    });
    let train = train
        .link(Link::shaft(0, 1, shaft.stiffness).damping(shaft.damping))
        .link(Link::shaft(1, 2, rope.stiffness).damping(rope.damping).efficiency(chain.efficiency()).rope())
        .link(Link::shaft(0, 3, 2000.0).damping(1.5))
        .source(2, Source::Constant(-weight));
    let mut host = train.pretensioned(0).unwrap().build().unwrap();
    let mut swing = 0.0_f64;
    for (tick, torque) in torque.iter().enumerate() {
        for (found, expected) in [(angle[tick], host.angle(0)), (speed[tick], host.speed(2))] {
            // the same series, summed by another program
            assert!((found - expected).abs() < 1e-11, "tick {tick}: {found} {expected}");
        }
        host.set_torque(0, *torque);
        host.advance(1e-4);
        swing = swing.max((host.angle(3) - host.angle(0)).abs());
    }
    // the ring swings: its inertia times the ramp over its stiffness, at least
    assert!(angle.len() == 5000 && angle[4999] > 1.0 && swing > 1e-4, "{} {swing}", angle[4999]);
}

#[test]
fn options_of_the_other_form_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    for (arguments, word) in [
        (&["fmu", MACHINE, "--core", "host"][..], "are for `c`"),
        (&["fmu", MACHINE, "--parts", "fluctuation"], "are for `c`"),
        (&["fmu", MACHINE, "--vibration-limit", "3"], "are for `c`"),
        (&["fmu", MACHINE, "--of", "plant", "--number", "fixed"], "--number is for a controller"),
        (&["c", MACHINE, "--core", "host", "--of", "plant"], "--of is for `fmu`"),
        (&["c", MACHINE], "--core"),
        (&["fmu", MACHINE, "--name", "2fast"], "is no name of a project"),
    ] {
        let ended = export(arguments, &out);
        let said = String::from_utf8(ended.stderr).unwrap();
        assert!(ended.status.code() == Some(2) && said.contains(word), "{arguments:?}: {said}");
    }
    assert!(String::from_utf8(export(&["fmu", MACHINE], folder.path()).stderr).unwrap().contains("is a folder"));
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
}

/// The hoist with another line or part, and the plants of it that are refused, before anything is compiled.
#[test]
fn a_machine_that_no_plant_is_true_of_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (file, out) = (folder.path().join("machine.toml"), folder.path().join("out"));
    let hoist = fs::read_to_string(MACHINE).unwrap();
    // behind the last mass
    let worm = "[[element]]\nkind = \"worm\"\nlabel = \"drive\"\nratio = 1.0\nefficiency = 0.8\n\
                back_efficiency = 0.7\n";
    let [(start, limits), (head, _), (motor, _)] =
        ["[encoder]", "[[element]]\nkind = \"gear\"", "[[element]]\nkind = \"shaft\""]
            .map(|at| hoist.split_once(at).unwrap());
    assert!(start.starts_with(head) && head.starts_with(motor));
    for (machine, word) in [
        (
            format!("{hoist}\n[[damper]]\nat = \"motor\"\nkind = \"friction\"\ninertia = 0.05\nexcitation = 5.0\n"),
            "a damper of the kind `friction`",
        ),
        (format!("{hoist}\n[[friction]]\non = \"motor\"\ntorque = 3.0\n"), "it has `friction`"),
        (format!("{hoist}\n[[torque]]\non = \"motor\"\nkind = \"constant\"\ntorque = 3.0\n"), "it has `torque`"),
        (format!("{head}{worm}\n[encoder]{limits}"), "the losses of `drive`"),
        (format!("{motor}[encoder]{limits}"), "it has no shaft"),
    ] {
        assert_ne!(machine, hoist, "{word}");
        fs::write(&file, machine).unwrap();
        let ended = export(&["fmu", file.to_str().unwrap(), "--of", "plant"], &out);
        let said = String::from_utf8(ended.stderr).unwrap();
        assert!(ended.status.code() == Some(2) && said.contains(word), "{said}");
    }
    // ten ticks a second are too few for a drive of it; the plant has no rate, and its worm keeps less backwards
    let gear = "kind = \"gear\"\nratio = 31.5            # motor speed over drum speed\nefficiency = 0.94\n";
    let worm = "kind = \"worm\"\nratio = 31.5\nefficiency = 0.94\nback_efficiency = 0.7\n";
    assert!(hoist.contains(gear));
    fs::write(&file, hoist.replace("rate_hz = 10000", "rate_hz = 10").replace(gear, worm)).unwrap();
    let file = file.to_str().unwrap();
    assert_eq!(export(&["fmu", file], &out).status.code(), Some(2));
    let plant = Fmu::new(file, "plant");
    let efficiencies = ["efficiency[2]", "back_efficiency[2]", "efficiency[1]", "back_efficiency[1]"];
    assert_eq!(efficiencies.map(|name| plant.start(name)), [0.94, 0.7, 1.0, 1.0]);
}
