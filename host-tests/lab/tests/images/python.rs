//! The wheel for Python: built, installed into an environment of its own and tested there; its drive against the one that
//! the compiler configures.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use driveline::number::Fixed;
use driveline_firmware::Words;
use driveline_lab::check::skip;
use driveline_qemu::clone::{target_directory, workspace};

use super::export::{MACHINE, ended_well, rows, run, same_bits, words};

/// An environment with what the wheel is built and tested with; where there is none, it is said why.
fn environment(place: &Path) -> Option<PathBuf> {
    let python = place.join("environment/bin/python");
    let is_new = Command::new("python3").args(["-c", "import sys; sys.exit(sys.version_info < (3, 10))"]).status();
    if !is_new.is_ok_and(|status| status.success()) {
        skip("there is no python3 from 3.10 on");
        return None;
    }
    let mut made = Command::new("python3");
    made.args(["-m", "venv"]).arg(place.join("environment"));
    let mut filled = Command::new(&python);
    filled.args(["-m", "pip", "install", "--quiet", "numpy", "maturin", "control", "matplotlib", "mypy", "jsonschema"]);
    let steps = [("python3 has no venv", made), ("the packages of PyPI are not there", filled)];
    for (what, mut command) in steps.into_iter().skip(usize::from(python.is_file())) {
        let ended = command.env("PIP_DISABLE_PIP_VERSION_CHECK", "1").output().ok()?;
        if !ended.status.success() {
            let said = String::from_utf8_lossy(&ended.stderr).into_owned();
            skip(format!("{what}: {}", said.lines().last().unwrap_or_default()));
            return None;
        }
    }
    Some(python)
}

#[test]
fn the_wheel_is_built_installed_and_has_the_bits_of_the_firmware() {
    let (root, place) = (workspace().unwrap(), target_directory().unwrap().join("python"));
    let Some(python) = environment(&place) else { return };
    // where maturin is
    let programs = python.parent().unwrap().to_owned();
    let path = std::env::var_os("PATH").unwrap_or_default();
    let path = std::env::join_paths([programs].into_iter().chain(std::env::split_paths(&path))).unwrap();
    let in_root = |arguments: &[&str]| {
        let mut command = Command::new(&python);
        command.args(arguments).env("PATH", &path).env("DRIVELINE_TOOL", env!("CARGO_BIN_EXE_lab"));
        let ended = command.current_dir(root).output().unwrap();
        ended_well(&ended);
        String::from_utf8_lossy(&ended.stderr).into_owned()
    };
    // as a user installs it, but of the profile of the tests: what both need is compiled once
    let install = ["-m", "pip", "install", "--quiet", "--no-build-isolation", "--no-deps", "--force-reinstall"];
    in_root(&[&install[..], &["--config-settings=build-args=--profile dev --locked", "./python"]].concat());
    // as the wheel says that it is typed
    in_root(&["-m", "mypy", "--strict", "--ignore-missing-imports", "--cache-dir=/dev/null", "python/driveline"]);
    let said = in_root(&["-m", "unittest", "discover", "-s", "python/tests"]);
    said.lines().filter(|line| line.contains("measured")).for_each(|line| println!("{line}"));

    for (number, run) in [("f32", run::<f32>(Words::Single)), ("fixed", run::<Fixed>(Words::Fixed))] {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("input"), words(&run)).unwrap();
        let script = root.join("python/tests/bits.py");
        let mut command = Command::new(&python);
        ended_well(&command.arg(script).args([MACHINE, number]).current_dir(folder.path()).output().unwrap());
        same_bits(&rows(&fs::read(folder.path().join("output")).unwrap()), &run);
    }
}
