//! `cosim`: the plant that is exported, to the bit, and a machine in C that was not written by this project's exporter,
//! by FMI 2.0 and 3.0. The exported FMUs are those of the test beside, which calls these.

use std::f64::consts::TAU;
use std::fs::{self, File};
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::export::ended_well;
use super::fmu::MACHINE;

fn cosim(drive: &Path, machine: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lab"));
    command.arg("cosim").args([drive, machine]).args(arguments).output().unwrap()
}

/// The table of a run.
pub fn run(drive: &Path, machine: &Path, arguments: &[&str]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("run.csv");
    ended_well(&cosim(drive, machine, &[arguments, &["--json", "--csv", file.to_str().unwrap()]].concat()));
    fs::read_to_string(file).unwrap()
}

/// A column of a table with a header.
pub fn column(table: &str, name: &str) -> Vec<f64> {
    let (header, rows) = table.split_once('\n').unwrap();
    let at = header.split(',').position(|other| other == name).unwrap_or_else(|| panic!("no {name}: {header}"));
    rows.lines().map(|row| row.split(',').nth(at).unwrap().parse().unwrap()).collect()
}

/// The drive is compiled from the machine file by the command; the machine is at the beginning of a tick where the
/// host's has it at the end of the one before.
pub fn has_the_bits_of_the_host(plant: &Path, expected: &[[f64; 13]]) {
    let arguments = ["--set", "0:load_torque=747", "--set", "2:load_torque=1000", "--setpoint", "100"];
    let rest = ["--setpoint", "2.5:60", "--time", "3"];
    let table = run(Path::new(MACHINE), plant, &[&arguments[..], &rest].concat());
    let names = [
        "drive.torque_setpoint",
        "drive.motor_speed",
        "drive.shaft_torque",
        "drive.load_speed",
        "drive.load_torque",
        "faults",
        "machine.motor_angle",
        "machine.encoder_angle",
        "machine.motor_speed",
        "machine.load_speed",
        "machine.applied_torque",
        "machine.shaft_torque[1]",
        "machine.shaft_torque[2]",
    ];
    for (at, name) in names.into_iter().enumerate() {
        let found = column(&table, name);
        assert_eq!(found.len(), expected.len());
        let late = usize::from(name.starts_with("machine."));
        for (tick, (found, expected)) in found[late..].iter().zip(expected).enumerate() {
            assert_eq!(found.to_bits(), expected[at].to_bits(), "{name}, tick {tick}: {found} {}", expected[at]);
        }
    }
}

/// The machine of `machine.c` as an FMU, compressed as tools do it.
fn machine(version: u32, folder: &Path) -> std::path::PathBuf {
    let library = folder.join("spin.so");
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/images/cosim/machine.c");
    let strict = ["-Wall", "-Wextra", "-Werror", "-std=c11", "-shared", "-fPIC", "-O1"];
    let mut compiler = Command::new("cc");
    ended_well(
        &compiler.args(strict).arg(format!("-DFMI={version}")).args([source, "-o"]).arg(&library).output().unwrap(),
    );
    let units = r#"<UnitDefinitions>
        <Unit name="N.m"><BaseUnit kg="1" m="2" s="-2"/></Unit><Unit name="kg.m2"><BaseUnit kg="1" m="2"/></Unit>
        <Unit name="r/min"><BaseUnit s="-1" factor="0.10471975511965977"/></Unit></UnitDefinitions>"#;
    let variables = [
        ("tau", "input", r#"start="0" unit="N.m""#),
        ("load", "input", r#"start="0" unit="N.m""#),
        ("J", "parameter", r#"start="1" unit="kg.m2""#),
        ("n", "output", r#"unit="r/min""#),
    ];
    let variable = |(at, (name, causality, rest)): (usize, &(&str, &str, &str))| {
        let head = format!(r#"name="{name}" valueReference="{}" causality="{causality}""#, at + 1);
        if version == 2 {
            format!("<ScalarVariable {head}><Real {rest}/></ScalarVariable>")
        } else {
            format!("<Float64 {head} {rest}/>")
        }
    };
    let variables: String = variables.iter().enumerate().map(variable).collect();
    let token = if version == 2 { "guid" } else { "instantiationToken" };
    let description = format!(
        "<fmiModelDescription fmiVersion=\"{version}.0\" modelName=\"Spin\" {token}=\"{{spin}}\">\
         <CoSimulation modelIdentifier=\"spin\"/>{units}<ModelVariables>{variables}</ModelVariables>\
         </fmiModelDescription>"
    );
    let arch = std::env::consts::ARCH;
    let platform = if version == 2 && arch == "x86_64" { "linux64".into() } else { format!("{arch}-linux") };
    let path = folder.join(format!("spin{version}.fmu"));
    let mut archive = ZipWriter::new(File::create(&path).unwrap());
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated);
    for (name, bytes) in [
        ("modelDescription.xml".to_owned(), description.into_bytes()),
        (format!("binaries/{platform}/spin.so"), fs::read(library).unwrap()),
    ] {
        archive.start_file(name, options).unwrap();
        archive.write_all(&bytes).unwrap();
    }
    archive.finish().unwrap();
    path
}

/// Its speed follows from the torques by Newton's law, and comes to the setpoint.
pub fn a_machine_of_another_tool_turns(drive: &Path) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("run.csv");
    let usual = ["--torque", "tau", "--speed", "n", "--set", "J=1.2", "--set", "0:load=747"];
    let rest = ["--set", "1.5:load=900", "--setpoint", "50", "--time", "3", "--csv", file.to_str().unwrap(), "--json"];
    let tables = [2, 3].map(|version| {
        let ended = cosim(drive, &machine(version, folder.path()), &[&usual[..], &rest].concat());
        ended_well(&ended);
        assert!(String::from_utf8(ended.stdout).unwrap().contains("\"faults\": []"));
        fs::read_to_string(&file).unwrap()
    });
    assert_eq!(tables[0], tables[1]);
    let [torques, speeds] = ["drive.torque_setpoint", "machine.n"].map(|name| column(&tables[0], name));
    let mut speed = 0.0;
    for (tick, (torque, found)) in torques.iter().zip(&speeds).enumerate() {
        // the rounding of a conversion and a sum in each of 30,000 ticks
        assert!((speed - found * TAU / 60.0).abs() < 1e-9, "tick {tick}: {speed} rad/s, {found} r/min");
        speed += 1e-4 * (torque - if tick < 15_000 { 747.0 } else { 900.0 }) / 1.2;
    }
    // 1 % is for what is left of the settling
    assert!((speed - 50.0).abs() < 0.5, "{speed}");

    let spin = machine(2, folder.path());
    for (arguments, code, words) in [
        (&["--torque", "n", "--speed", "n"][..], 2, "`n` of `Spin` is of causality output, expected an input"),
        (&["--torque", "tau", "--angle", "n"], 2, "`n` of `Spin` is in r/min, expected an angle (rad)"),
        (&["--torque", "tau", "--speed", "w"], 2, "has no variable `w`; each output that is a number: n"),
        (
            &["--torque", "tau", "--speed", "n", "--set", "I=1"],
            2,
            "has no variable `I`; each parameter that is a number: J",
        ),
        // it reaches its largest speed, 2000 r/min, within three ticks
        (&["--torque", "tau", "--speed", "n", "--set", "0:load=-1e6"], 1, "`Spin`: the step of 0.0001 s from "),
        (&["--torque", "tau", "--speed", "n", "--time", "0"], 2, "expected 1 to"),
    ] {
        let ended = cosim(drive, &spin, arguments);
        let said = String::from_utf8(ended.stderr).unwrap();
        assert!(ended.status.code() == Some(code) && said.contains(words), "{arguments:?}: {said}");
    }
    let swapped = cosim(&spin, &spin, &usual);
    let said = String::from_utf8(swapped.stderr).unwrap();
    assert!(said.contains("no fixedInternalStepSize; expected an FMU of `cargo driveline export fmu`"), "{said}");
    assert!(String::from_utf8(cosim(drive, Path::new(MACHINE), &usual).stderr).unwrap().contains("is no FMU"));
}
