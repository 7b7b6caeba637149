//! Results onto sources and onto one another, by name, symbolic link, hard link and another way.

use std::ffi::OsString;
use std::fs;
use std::os::unix::fs::symlink;

use super::cases::sources;
use super::run::Place;

/// Each command that reads a file, its sources and every option that names a result.
const COMMANDS: [(&str, &[&str], &[&str]); 13] = [
    ("modes machine.toml", &["machine.toml"], &["--html"]),
    ("modes train.toml", &["train.toml"], &["--html"]),
    ("rotor rotor.toml", &["rotor.toml"], &["--html"]),
    ("balancing fan.toml", &["fan.toml"], &["--html"]),
    ("simulate train.toml", &["train.toml"], &["--html", "--csv"]),
    ("watch stream.bin", &["stream.bin"], &["--csv"]),
    ("identify bench.csv --rate 2500", &["bench.csv"], &["--html", "--toml"]),
    ("replay bench.csv --machine machine.toml", &["bench.csv", "machine.toml"], &["--html", "--csv"]),
    ("campaign machine.toml", &["machine.toml"], &["--html", "--results"]),
    ("campaign merge one.draws two.draws", &["one.draws", "two.draws"], &["--html", "--results"]),
    ("cosim machine.toml machine.fmu", &["machine.toml", "machine.fmu"], &["--html", "--csv"]),
    ("cosim drive.fmu machine.fmu", &["drive.fmu", "machine.fmu"], &["--html", "--csv"]),
    ("export fmu machine.toml", &["machine.toml"], &["--out"]),
];

fn place() -> Place {
    let mut place = sources();
    for name in ["stream.bin", "drive.fmu", "machine.fmu"] {
        place.put(name, name.as_bytes());
    }
    place
}

/// Refused with its sentence, and every source is as it was.
fn refused(place: &Place, line: &str, results: &[(&str, &str)], sentence: &str) {
    let results = results.iter().flat_map(|(option, name)| [*option, *name]);
    let arguments: Vec<_> = line.split(' ').chain(results).map(OsString::from).collect();
    let ended = place.run(&arguments, &[]);
    let said = ended.said();
    assert!(ended.code == Some(2) && said.contains(sentence), "{arguments:?}: {:?}, {said}", ended.code);
    place.clear();
    let faults = place.faults(&[], false);
    assert!(faults.is_empty(), "{arguments:?}: {faults:?}");
}

#[test]
fn no_result_is_written_onto_a_source() {
    let place = place();
    for (line, sources, options) in COMMANDS {
        for (source, option) in sources.iter().flat_map(|source| options.iter().map(move |option| (source, option))) {
            for way in ["itself", "symbolic", "hard", "around", "chain"] {
                let at = |name: &str| place.at(name);
                let name = match way {
                    "itself" => (*source).to_owned(),
                    "around" => {
                        fs::create_dir(at("sub")).unwrap();
                        format!("sub/../{source}")
                    }
                    "symbolic" => {
                        symlink(source, at("symbolic")).unwrap();
                        "symbolic".to_owned()
                    }
                    "hard" => {
                        fs::hard_link(at(source), at("hard")).unwrap();
                        "hard".to_owned()
                    }
                    _ => {
                        // a symbolic link to a hard link
                        fs::hard_link(at(source), at("hard")).unwrap();
                        symlink(at("hard"), at("chain")).unwrap();
                        "chain".to_owned()
                    }
                };
                refused(&place, line, &[(option, &name)], "would overwrite its own input");
            }
        }
    }
}

#[test]
fn no_result_is_written_onto_another() {
    let place = place();
    for (line, _, options) in COMMANDS {
        let [one, other] = options else { continue };
        fs::write(place.at("there"), "").unwrap();
        symlink("there", place.at("link")).unwrap();
        refused(&place, line, &[(one, "there"), (other, "link")], "would hold both");
        refused(&place, line, &[(one, "new"), (other, "./new")], "would hold both");
        // a link to a file that is not there yet
        symlink("new", place.at("dangling")).unwrap();
        refused(&place, line, &[(one, "new"), (other, "dangling")], "would hold both");
    }
}
