//! A project that `new` writes: run in QEMU, tested on the host, built for the boards that QEMU does not have.

use std::path::Path;
use std::process::{Command, Output};

use driveline_qemu::clone::target_directory;
use driveline_qemu::setup::cargo;

/// A folder in the clone, whose cargo settings contradict a project's own.
const INSIDE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/../crane");
const HOIST: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../command/machines/hoist.toml");
const MILL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../command/machines/mill.toml");
const AXIS: &str = include_str!("../../../command/machines/axis.toml");

fn new(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lab"));
    command.arg("new").args(arguments).current_dir(folder).output().unwrap()
}

#[track_caller]
fn ended_well(ended: &Output) -> String {
    let said = [&ended.stdout, &ended.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
    assert!(ended.status.success(), "{}\n{}", ended.status, said.join("\n"));
    said.join("\n")
}

/// Cargo in a project. Its dependencies are compiled once for all projects and runs of this test.
fn in_project(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(cargo());
    command
        .args(arguments)
        .current_dir(folder)
        .env("CARGO_TARGET_DIR", target_directory().unwrap().join("exported/target"));
    // flags of this test's own cargo
    command.env_remove("RUSTFLAGS").env_remove("CARGO_ENCODED_RUSTFLAGS").output().unwrap()
}

/// Rows of time, motor's torque and four estimates that a program prints among its text.
fn rows(said: &str) -> Vec<Vec<f64>> {
    let numbers = |line: &str| -> Vec<f64> {
        line.split_whitespace().filter_map(|word| word.trim_matches(['[', ']', ',']).parse().ok()).collect()
    };
    said.lines().map(numbers).filter(|row| row.len() == 6).collect()
}

/// The run of the example in C, on the host.
fn in_c(folder: &Path, machine: &str) -> String {
    let mut export = Command::new(env!("CARGO_BIN_EXE_lab"));
    export.args(["export", "c", machine, "--core", "host", "--number", "f32", "--out", "in-c"]).current_dir(folder);
    ended_well(&export.output().unwrap());
    ended_well(&Command::new("make").args(["--silent", "-C", "in-c", "run"]).current_dir(folder).output().unwrap())
}

/// The rows of the firmware and of the example in C are those on the full solver: to 2 % of rated where a gap opens that
/// two masses do not have, to 0.5 % with the rope's swing alone.
#[test]
fn a_project_runs_in_qemu_on_each_board_and_passes_its_test() {
    let place = tempfile::tempdir().unwrap();
    let damped = place.path().join("damped.toml");
    let dampers = "[[damper]]\nat = \"coupling\"\nkind = \"tuned\"\ninertia = 15.0\n[[damper]]\nat = \"coupling\"\n\
                   kind = \"friction\"\ninertia = 10.0\nexcitation = 1.0e3\n[speed_loop]\nbandwidth = 0.3\nramp = 5.0\n";
    std::fs::write(&damped, format!("{}\n{dampers}", std::fs::read_to_string(MILL).unwrap())).unwrap();
    for (name, machine, [torque, speed], share, board, parts) in [
        ("crane-m4f", HOIST, [675.0, 155.0], 0.005, "qemu-m4f", &[][..]),
        ("mill-m3", damped.to_str().unwrap(), [2.0e5, 12.0], 0.02, "qemu-m3", &["--parts", "fluctuation"]),
    ] {
        let options = [&[name, "--machine", machine, "--board", board], parts].concat();
        ended_well(&new(place.path(), &options));
        let folder = place.path().join(name);
        let said = ended_well(&in_project(&folder, &["run", "--release"]));
        let printed = rows(&said);
        // an integral leaves no error: what is left of the settling, at the largest speed of the file
        assert!((printed.last().unwrap()[2] - speed).abs() < 0.01 * speed, "{said}");
        assert_eq!(said.contains("coefficient of speed fluctuation"), board == "qemu-m3", "{said}");
        ended_well(&in_project(&folder, &["test"]));
        let solver = ["test", "--", "--nocapture", "the_drive_is_right_on_the_full_solver"];
        let expected = rows(&ended_well(&in_project(&folder, &solver)));
        // the C program prints whole numbers
        for (of, printed, rounding) in [("QEMU", printed, 0.05), ("C", rows(&in_c(place.path(), machine)), 0.5)] {
            assert!(printed.len() >= 8 && printed.len() <= expected.len(), "{of}: {printed:?}");
            for (row, exact) in printed.iter().zip(&expected) {
                for at in 1..6 {
                    let rated = if at == 2 || at == 3 { speed } else { torque };
                    assert!((row[at] - exact[at]).abs() < share * rated + rounding, "{of}: {row:?}, {exact:?}");
                }
            }
        }
        std::fs::remove_dir_all(place.path().join("in-c")).unwrap();
    }
}

/// The hoist's 12 t weigh 747 N m at the motor, of 1,350 N m: not so 24 t.
#[test]
fn a_load_that_the_torque_does_not_hold_is_a_warning() {
    let place = tempfile::tempdir().unwrap();
    let heavy = place.path().join("heavy.toml");
    std::fs::write(&heavy, std::fs::read_to_string(HOIST).unwrap().replace("mass = 12000.0", "mass = 24000.0"))
        .unwrap();
    for (name, machine, told) in [("light", HOIST, false), ("heavy", heavy.to_str().unwrap(), true)] {
        let said = ended_well(&new(place.path(), &[name, "--machine", machine]));
        assert_eq!(said.contains("warning: the weight of 1\u{202f}494 N m at the motor is not held"), told, "{said}");
    }
}

#[test]
fn a_project_is_built_for_the_boards_that_qemu_does_not_have() {
    let place = tempfile::tempdir().unwrap();
    // All that a machine file says of the loop. With this bandwidth, and the damping as described, one mass has the
    // margins, and is as good.
    let loop_of_file = "[speed_loop]\nbandwidth = 0.2\n[actuator]\nbandwidth = 900.0\n\
                        [tolerance]\nstiffness = 0.1\ndamping = 0\n";
    std::fs::write(place.path().join("axis.toml"), format!("{AXIS}\n{loop_of_file}")).unwrap();
    for (board, machine) in [("nucleo-g474re", &[][..]), ("generic", &["--machine", "axis.toml"])] {
        ended_well(&new(place.path(), &[&[board, "--board", board], machine].concat()));
        let build = ["build", "--release", "--target", "thumbv7em-none-eabihf"];
        let said = ended_well(&in_project(&place.path().join(board), &build));
        assert!(!said.contains("warning"), "{said}");
    }
    let of_axis = |file: &str| std::fs::read_to_string(place.path().join("generic/src").join(file)).unwrap();
    assert!(of_axis("lib.rs").contains("GearedObserver<RigidObserver>"));
    for constant in ["const TUNING", "const ACTUATOR", "stiffness: Spread::between(0.9, 1.1)"] {
        assert!(of_axis("machine.rs").contains(constant), "{constant}");
    }
}

/// A refused project leaves nothing, and says what is wrong.
#[test]
fn a_project_that_cannot_be_is_refused_and_leaves_nothing() {
    let place = tempfile::tempdir().unwrap();
    let ship = HOIST.replace("hoist", "ship");
    for (arguments, word) in [
        (&["2fast"][..], "is no name of a project"),
        (&["match"], "is a reserved word"),
        (&["none/roll"], "make that first"),
        (&[INSIDE], "name a folder outside, such as ../crane"),
        (&["ship", "--machine", &ship], "it has branches"),
        (&["roll", "--machine", "no.toml"], "no.toml"),
        (&["roll", "--parts", "phasors"], "--vibration-limit"),
        (&["roll", "--vibration-limit", "1"], "--parts phasors"),
        (&["roll", "--parts", "phasors", "--vibration-limit", "-1"], "expected a value above 0"),
    ] {
        let ended = new(place.path(), arguments);
        let said = String::from_utf8(ended.stderr).unwrap();
        assert!(ended.status.code() == Some(2) && said.contains(word), "{arguments:?}: {said}");
        assert_eq!(std::fs::read_dir(&place).unwrap().count(), 0, "{arguments:?}");
    }
    assert!(!Path::new(INSIDE).exists());
    std::fs::create_dir(place.path().join("roll")).unwrap();
    std::fs::write(place.path().join("roll/mine"), "kept").unwrap();
    let said = String::from_utf8(new(place.path(), &["roll"]).stderr).unwrap();
    assert!(said.contains("exists and is not empty"), "{said}");
    assert_eq!(std::fs::read_dir(place.path().join("roll")).unwrap().count(), 1);
}
