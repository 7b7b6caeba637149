//! Every kind of page in a browser, on a narrow and a wide screen and in print.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::browser::Browser;
use crate::sample;

/// Pages that a command writes within seconds: name of the page and arguments.
const QUICK: [(&str, &str); 11] = [
    ("modes", "modes hoist.toml"),
    ("design", "design mill.toml"),
    ("modes-train", "modes gear-pair.toml"),
    ("campbell", "modes ship.toml"),
    ("rotor", "rotor three_discs.toml"),
    ("balancing", "balancing fan-balance.toml"),
    ("simulate", "simulate gear-pair.toml"),
    ("simulate-branches", "simulate tilting.toml"),
    ("identify", "identify two-mass-bench.csv --rate 2500 --torque-constant 0.564 --to 5 --toml bench.toml"),
    ("replay", "replay two-mass-bench.csv --machine bench.toml --rate 2500 --torque-constant 0.564 --from 5"),
    ("campaign", "campaign roll.toml --draws 12 --results roll.draws"),
];

/// Pages of commands that compile: firmware for QEMU, or a drive for a machine that is an FMU.
const COMPILED: [(&str, &str); 2] =
    [("run", "run hoist --quick --all"), ("cosim", "cosim machines/roll.toml PLANT --time 0.2")];

/// Largest page (bytes): a phone opens it, and a mail takes it.
const LARGEST: u64 = 5_000_000;

fn driveline(place: &Path, arguments: &[&str]) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lab"));
    let output = command.args(arguments).current_dir(place).output().unwrap();
    assert!(output.status.success(), "{arguments:?}: {output:?}");
}

/// Opens every page of a folder in every view.
fn read(folder: &Path) {
    let mut browser = Browser::start();
    let mut found = Vec::new();
    let mut pages: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    pages.retain(|path| path.extension().is_some_and(|extension| extension == "html"));
    pages.sort();
    for page in &pages {
        let (name, address) = (page.file_stem().unwrap().to_string_lossy(), format!("file://{}", page.display()));
        let size = fs::metadata(page).unwrap().len();
        assert!(size < LARGEST, "{name}: {size} bytes");
        browser.open(&address);
        // A4 with margins of 1 cm, at 96 pixels an inch
        for (width, medium) in [(400, "screen"), (1300, "screen"), (718, "print")] {
            browser.show(width, medium);
            let script = format!("{}({})", include_str!("pages.js").trim_end(), width == 400);
            for finding in browser.run(&script).as_array().unwrap() {
                found.push(format!("{name}, {width} {medium}: {}", finding.as_str().unwrap()));
            }
        }
        let asked = std::mem::take(&mut browser.asked);
        found.extend(asked.iter().filter(|asked| **asked != address).map(|asked| format!("{name} loads {asked}")));
        found.extend(browser.said.drain(..).map(|said| format!("{name} says {said}")));
    }
    println!("measured: {} pages in 3 views, {} findings", pages.len(), found.len());
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
#[ignore = "needs Chromium: cargo lab check --only pages"]
fn pages_read_well_in_a_browser() {
    let folder = tempfile::tempdir().unwrap();
    let own = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../command"));
    for files in ["machines", "trains", "rotors", "recordings"] {
        for file in fs::read_dir(own.join(files)).unwrap().map(Result::unwrap) {
            fs::copy(file.path(), folder.path().join(file.file_name())).unwrap();
        }
    }
    for (name, line) in QUICK {
        let page = format!("{name}.html");
        driveline(folder.path(), &[&line.split(' ').collect::<Vec<_>>()[..], &["--html", &page]].concat());
    }
    fs::write(folder.path().join("run.html"), sample::report().page()).unwrap();
    read(folder.path());
}

#[test]
#[ignore = "needs Chromium, and QEMU for minutes: cargo lab check --long --only pages"]
fn pages_of_firmware_read_well_in_a_browser() {
    let folder = tempfile::tempdir().unwrap();
    let (own, plant) = (Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../command")), folder.path().join("plant.fmu"));
    let plant = plant.to_str().unwrap();
    driveline(own, &["export", "fmu", "machines/roll.toml", "--of", "plant", "--out", plant]);
    for (name, line) in COMPILED {
        let page = folder.path().join(format!("{name}.html"));
        let words = line.split(' ').map(|word| if word == "PLANT" { plant } else { word });
        driveline(own, &[&words.collect::<Vec<_>>()[..], &["--html", page.to_str().unwrap()]].concat());
    }
    read(folder.path());
}
