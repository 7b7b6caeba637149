//! A copy of the library whose source has a switch for each mutant, and its test programs.

use std::collections::{BTreeMap, HashSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::Value;

use crate::list::Mutant;
use crate::rewrite::rewrite;

/// The test programs: package, kind and name, the quickest first.
const PROGRAMS: [[&str; 3]; 3] =
    [["driveline", "--lib", ""], ["driveline", "--test", "tick"], ["driveline", "--test", "library"]];

/// Those that the command has, so that the library is built once.
const FEATURES: &str = "balancing,parameters,telemetry";

const HEAD: &str = "#![feature(core_intrinsics, const_eval_select)]
#![allow(warnings, internal_features, arithmetic_overflow, unconditional_panic)]
";

/// The copy at `copy` of the clone at `root`, with the mutants that compile behind switches; their numbers.
pub fn switched(root: &Path, copy: &Path, mutants: &[Mutant]) -> HashSet<u32> {
    let mut files: BTreeMap<&str, Vec<&Mutant>> = BTreeMap::new();
    for mutant in mutants {
        files.entry(&mutant.file).or_default().push(mutant);
    }
    let listed = Command::new("git").current_dir(root).arg("ls-files").output().expect("git");
    for file in String::from_utf8_lossy(&listed.stdout).lines() {
        if let Ok(bytes) = fs::read(root.join(file))
            && !files.contains_key(file)
            && file != "src/lib.rs"
        {
            write(&copy.join(file), &bytes);
        }
    }
    let head = fs::read_to_string(root.join("src/lib.rs")).expect("a library").replace("#![forbid(unsafe_code)]", "");
    write(&copy.join("src/lib.rs"), format!("{HEAD}{head}\n#[doc(hidden)]\npub mod switch;\n").as_bytes());
    write(&copy.join("src/switch.rs"), include_bytes!("switch.rs"));
    let mut refused = HashSet::new();
    loop {
        let mut texts = BTreeMap::new();
        let mut switched = HashSet::new();
        for (&file, of_it) in &files {
            let source = fs::read_to_string(root.join(file)).expect("a file of the list");
            let left: Vec<_> = of_it.iter().filter(|mutant| !refused.contains(&mutant.number)).copied().collect();
            let (text, found) = rewrite(&source, &left);
            write(&copy.join(file), text.as_bytes());
            texts.insert(file, text);
            switched.extend(found);
        }
        let wrong = errors(copy, &texts);
        eprintln!("{} mutants behind switches, {} of them do not compile", switched.len(), wrong.len());
        if wrong.is_empty() {
            return switched;
        }
        refused.extend(wrong);
    }
}

/// A file that has these bytes is left alone: the build goes by its time.
fn write(to: &Path, bytes: &[u8]) {
    if fs::read(to).ok().as_deref() != Some(bytes) {
        fs::create_dir_all(to.parent().expect("a folder")).expect("the copy");
        fs::write(to, bytes).expect("the copy");
    }
}

/// `cargo` in the copy. This program stands in for the compiler of its packages: the intrinsic behind the switch is not
/// stable.
fn cargo(copy: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new("cargo");
    command.current_dir(copy).args(arguments).args(["--message-format", "json"]);
    command.env("RUSTC_WORKSPACE_WRAPPER", std::env::current_exe().expect("this program"));
    command.stderr(Stdio::inherit());
    command
}

fn messages(command: &mut Command) -> Vec<Value> {
    let output = command.output().expect("cargo");
    let lines = String::from_utf8_lossy(&output.stdout).into_owned();
    lines.lines().filter_map(|line| serde_json::from_str(line).ok()).collect()
}

/// The mutants at which the compiler finds errors.
fn errors(copy: &Path, texts: &BTreeMap<&str, String>) -> HashSet<u32> {
    let mut command = cargo(copy, &["check", "--package", "driveline", "--features", FEATURES]);
    let mut wrong = HashSet::new();
    for message in messages(&mut command) {
        let message = &message["message"];
        if message["level"] != "error" {
            continue;
        }
        let spans = message["spans"].as_array().into_iter().flatten();
        let mut placed = false;
        for span in spans.filter(|span| span["is_primary"] == true) {
            let Some(text) = span["file_name"].as_str().and_then(|file| texts.get(file)) else { continue };
            let end = span["byte_start"].as_u64().expect("a place") as usize;
            if let Some((_, behind)) = text[..end].rsplit_once("switch::on(") {
                let digits = behind.split_terminator(|letter: char| !letter.is_ascii_digit()).next();
                placed = true;
                wrong.extend(digits.and_then(|digits| digits.parse::<u32>().ok()));
            }
        }
        if !placed && !message["spans"].as_array().is_some_and(Vec::is_empty) {
            eprintln!("{}", message["rendered"].as_str().unwrap_or_default());
        }
    }
    wrong
}

/// A test program and the folder that it runs in.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Program {
    pub path: PathBuf,
    pub folder: PathBuf,
}

/// The test programs of the copy, of the library's own package alone where that is to be `quick`.
pub fn programs(copy: &Path, quick: bool) -> Vec<Program> {
    let mut programs = vec![];
    for [package, kind, name] in PROGRAMS {
        if quick && package != "driveline" {
            continue;
        }
        let mut arguments = vec!["test", "--no-run", "--package", package, kind];
        arguments.extend(Some(name).filter(|name| !name.is_empty()));
        if package == "driveline" {
            arguments.extend(["--features", FEATURES]);
        }
        let found = messages(&mut cargo(copy, &arguments));
        let of_tests = found.iter().filter(|message| message["profile"]["test"] == true);
        let mut program = of_tests.filter_map(|message| {
            let manifest = Path::new(message["manifest_path"].as_str()?);
            Some(Program { path: message["executable"].as_str()?.into(), folder: manifest.parent()?.into() })
        });
        programs.push(program.next_back().unwrap_or_else(|| panic!("the tests of {package} compile")));
    }
    programs
}
