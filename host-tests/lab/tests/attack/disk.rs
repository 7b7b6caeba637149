//! A disk that is full at every write: no page is half, what stood there stays, and every figure is printed.
//!
//! A limit of the size of files (`ulimit -f`) stands for the disk, with its signal ignored: the write that passes it
//! fails, at any place of a file, on any machine and without rights.

use std::fs;
use std::process::Command;

use driveline_lab::check::skip;

use super::cases::{frames, sources};
use super::run::{Place, wrong};

/// Commands with a result each, and its option.
const COMMANDS: [(&str, &str); 9] = [
    ("modes machine.toml --json", "--html"),
    ("modes train.toml --json", "--html"),
    ("rotor rotor.toml --json", "--html"),
    ("balancing fan.toml --json", "--html"),
    ("simulate train.toml --json", "--html"),
    ("simulate train.toml --json", "--csv"),
    ("identify bench.csv --rate 2500 --torque-constant 0.564 --to 5 --json", "--html"),
    ("identify bench.csv --rate 2500 --torque-constant 0.564 --to 5 --json", "--toml"),
    ("campaign merge one.draws two.draws --json", "--html"),
];

/// The command line of this line, whose files may have so many blocks of 512 bytes. Its output goes through pipes,
/// which have no limit.
fn limited(place: &Place, blocks: u64, line: &str) -> Command {
    let mut command = place.command("/bin/sh");
    let program = env!("CARGO_BIN_EXE_lab");
    let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec '{program}' {line}");
    command.args(["-c", &script]);
    command
}

/// At each of some blocks of each result.
fn full(steps: u64) -> usize {
    let place = sources();
    let mut tried = 0;
    for (line, option) in COMMANDS {
        let line = format!("{line} {option} result");
        let whole = place.piped(limited(&place, 1_000_000, &line));
        assert_eq!(whole.code, Some(0), "{line}: {}", whole.said());
        let length = fs::metadata(place.at("result")).unwrap().len();
        for step in 0..steps {
            // through the file: from nothing to a block less than all of it
            let blocks = length.saturating_sub(1) / 512 * step / steps.max(2).saturating_sub(1);
            let old = step % 2 == 0;
            let _ = fs::remove_file(place.at("result"));
            if old {
                fs::write(place.at("result"), "the old one").unwrap();
            }
            let ended = place.piped(limited(&place, blocks, &line));
            let at = format!("{line}, {} of {length} bytes", 512 * blocks);
            assert_eq!((ended.code, &ended.out), (Some(1), &whole.out), "{at}: {}", ended.said());
            assert!(ended.said().contains("cannot be written"), "{at}: {}", ended.said());
            let faults = wrong(&ended, true);
            assert!(faults.is_empty(), "{at}: {faults:?}");
            let there = fs::read(place.at("result")).ok();
            assert_eq!(there.as_deref(), old.then_some(&b"the old one"[..]), "{at}");
            let _ = fs::remove_file(place.at("result"));
            let faults = place.faults(&[], false);
            assert!(faults.is_empty(), "{at}: {faults:?}");
            tried += 1;
        }
    }
    tried
}

#[test]
fn a_full_disk_loses_nothing() {
    full(3);
}

#[test]
#[ignore = "minutes"]
fn a_full_disk_at_every_write_loses_nothing() {
    println!("measured: {} full disks", full(40));
}

/// Of a stream the file keeps the lines that had room, and all that was seen is printed.
#[test]
fn a_full_disk_ends_a_recording_and_not_its_figures() {
    let mut place = Place::new();
    place.put("stream.bin", &frames().repeat(20));
    let ended = place.piped(limited(&place, 4, "watch stream.bin --json --csv run.csv"));
    assert_eq!(ended.code, Some(1), "{}", ended.said());
    assert!(ended.said().contains("run.csv"), "{}", ended.said());
    let seen: serde_json::Value = serde_json::from_slice(&ended.out).unwrap();
    assert_eq!(seen["records"], 1_200);
    let kept = fs::read_to_string(place.at("run.csv")).unwrap();
    assert!(kept.len() <= 4 * 512 && kept.lines().count() > 30, "{} bytes", kept.len());
}

/// A disk without room for the first lines leaves the old table as it was.
#[test]
fn a_full_disk_keeps_the_old_recording() {
    let mut place = Place::new();
    place.put("stream.bin", &frames());
    place.put("run.csv", b"the old one");
    let ended = place.piped(limited(&place, 0, "watch stream.bin --json --csv run.csv"));
    assert_eq!(ended.code, Some(1), "{}", ended.said());
    assert!(ended.said().contains("run.csv cannot be written"), "{}", ended.said());
    assert_eq!(fs::read_to_string(place.at("run.csv")).unwrap(), "the old one");
    let faults = place.faults(&[], false);
    assert!(faults.is_empty(), "{faults:?}");
}

/// Where results go to a file that is full, that is said, and the page is written all the same.
#[test]
fn full_standard_output_is_said() {
    let place = sources();
    for line in ["modes machine.toml --html page.html", "modes machine.toml --html page.html --json"] {
        let mut command = limited(&place, 1_000_000, line);
        let output = fs::OpenOptions::new().write(true).open("/dev/full");
        let Ok(output) = output else {
            skip("this system has no /dev/full");
            return;
        };
        let ended = command.stdout(output).output().unwrap();
        assert_eq!(ended.status.code(), Some(1));
        let said = String::from_utf8(ended.stderr).unwrap();
        assert!(said.contains("standard output cannot be written"), "{said}");
        assert_eq!(said.starts_with('{'), line.ends_with("--json"), "{said}");
        assert!(fs::read_to_string(place.at("page.html")).unwrap().trim_end().ends_with("</html>"));
    }
}

/// Folders for temporary files that are not there or may not be written.
#[test]
fn a_temporary_folder_that_cannot_be_made_is_said() {
    let mut place = Place::new();
    place.put("machine.fmu", &super::malformed::fmu(&mut super::random::Random::new(1), "<x a=\"b\"/>"));
    for folder in ["/no/such/folder", "/dev/null"] {
        let mut command = place.command(env!("CARGO_BIN_EXE_lab"));
        command.args(["cosim", "machine.fmu", "machine.fmu", "--json"]).env("TMPDIR", folder);
        let ended = command.output().unwrap();
        let said = String::from_utf8(ended.stderr).unwrap();
        assert!(matches!(ended.status.code(), Some(1 | 2)), "{said}");
        assert!(said.contains(folder) && said.contains("TMPDIR names another"), "{said}");
    }
}
