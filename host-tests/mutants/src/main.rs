//! Mutants of the tick path: all in one build, each behind a switch, and which of them the tests notice.

mod build;
mod list;
mod rewrite;
mod run;

use std::collections::BTreeMap;
use std::fs;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};
use std::{env, io::Write};

use serde::Serialize;
use serde_json::json;

const HELP: &str = "Mutants of the tick path, all in one build, each behind a switch; which of them the tests notice.

It needs `cargo install cargo-mutants --locked`, and works in a copy of this clone.

options:
  --copy FOLDER      the copy [target/mutants of this crate]; `outcomes.tsv` in it has each mutant's outcome
  --minutes MINUTES  stop after so long: what was judged is a random sample [all]
  --seed NUMBER      order of the mutants [1]
  --longest SECONDS  leave out tests that take longer, alone [1]
  --file PREFIX      mutants of files that begin with it; as often as wanted [src/]
  --quick            the tests of the library's own package alone, without the host's: a build of minutes
  --again            leave out those that a test noticed the last time
  --least PERCENT    exit code 1 where less than that of a part is killed [0]
  --json             print `{parts: [...], left: [...]}`: the shares, and the mutants that no test noticed";

/// Between two lines of progress.
const PROGRESS: Duration = Duration::from_secs(30);

struct Options {
    copy: PathBuf,
    minutes: f64,
    seed: u64,
    longest: f64,
    files: Vec<String>,
    quick: bool,
    again: bool,
    least: f64,
    json: bool,
}

fn options(root: &Path) -> Options {
    let copy = root.join("host-tests/mutants/target/mutants");
    let mut options = Options {
        copy,
        minutes: f64::INFINITY,
        seed: 1,
        longest: 1.0,
        files: vec![],
        quick: false,
        again: false,
        least: 0.0,
        json: false,
    };
    let mut arguments = env::args().skip(1);
    while let Some(name) = arguments.next() {
        let mut value = || arguments.next().unwrap_or_else(|| stop(&format!("{name} needs a value")));
        let number = |text: String| match text.parse() {
            Ok(number) if (0.0..1e9).contains(&number) => number,
            _ => stop(&format!("{name} is `{text}`, expected a number from 0 to below 1e9")),
        };
        match name.as_str() {
            "--copy" => options.copy = value().into(),
            "--minutes" => options.minutes = number(value()),
            "--seed" => options.seed = number(value()) as u64,
            "--longest" => options.longest = number(value()),
            "--file" => options.files.push(value()),
            "--quick" => options.quick = true,
            "--again" => options.again = true,
            "--least" => options.least = number(value()),
            "--json" => options.json = true,
            "--help" | "-h" => {
                println!("{HELP}");
                std::process::exit(0)
            }
            _ => stop(&format!("there is no option {name}; --help lists them")),
        }
    }
    options
}

fn stop(sentence: &str) -> ! {
    eprintln!("{sentence}");
    std::process::exit(2)
}

fn main() {
    let compiler: Vec<_> = env::args_os().skip(1).collect();
    if compiler.first().is_some_and(|first| Path::new(first).ends_with("rustc")) {
        let error = Command::new(&compiler[0]).args(&compiler[1..]).env("RUSTC_BOOTSTRAP", "1").exec();
        stop(&error.to_string());
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().expect("the clone");
    let options = options(&root);
    let place = format!("--copy {}", options.copy.display());
    if let Err(error) = fs::create_dir_all(&options.copy) {
        stop(&format!("{place}: {error}"));
    }
    // the copy's sources are overwritten: none but those of an earlier copy
    let is_empty = fs::read_dir(&options.copy).is_ok_and(|mut entries| entries.next().is_none());
    if !is_empty && !options.copy.join("src/switch.rs").exists() {
        stop(&format!("{place}: found files, expected an empty folder or an earlier copy"));
    }
    let mutants = list::list(&root);
    let switched = build::switched(&root, &options.copy, &mutants);
    let results = options.copy.join("outcomes.tsv");
    let before = read(&results);
    let programs = build::programs(&options.copy, options.quick);
    let tests = run::tests(&programs, Duration::from_secs_f64(options.longest), &options.copy.join("reached"));

    let chosen = |mutant: &&list::Mutant| {
        options.files.is_empty() || options.files.iter().any(|prefix| mutant.file.starts_with(prefix))
    };
    let mut order: Vec<_> = mutants.iter().filter(chosen).collect();
    order.retain(|mutant| !options.again || before.get(&mutant.key).is_none_or(|outcome| !noticed(outcome)));
    if order.is_empty() && !options.again {
        stop("no mutant is in these files");
    }
    order.sort_by_key(|mutant| mixed(options.seed, mutant.number));
    let (start, all) = (Instant::now(), order.len());
    let mut told = start;
    // of files that were not chosen the last outcomes stand
    let mut outcomes = before;
    if !options.again {
        order.iter().for_each(|mutant| drop(outcomes.remove(&mutant.key)));
    }
    let progress = options.copy.join("progress.tsv");
    let mut file =
        fs::File::create(&progress).unwrap_or_else(|error| stop(&format!("writing {}: {error}", progress.display())));
    for (done, mutant) in order.into_iter().enumerate() {
        if told.elapsed() > PROGRESS {
            told = Instant::now();
            let left = start.elapsed().as_secs_f64() / 60.0 * (all - done) as f64 / done.max(1) as f64;
            eprintln!("{done} of {all} mutants judged, {left:.0} min for the others");
            write(&results, &outcomes);
        }
        if start.elapsed().as_secs_f64() > 60.0 * options.minutes {
            break;
        }
        let outcome = match switched.contains(&mutant.number) {
            true => run::judge(mutant.number, &tests).to_string(),
            false => "does not compile".to_owned(),
        };
        let _ = writeln!(file, "{}\t{outcome}\t{}", mutant.key, mutant.name);
        outcomes.insert(mutant.key.clone(), outcome);
    }
    write(&results, &outcomes);
    let parts = parts(&mutants, &outcomes);
    if options.json {
        let left = mutants.iter().filter_map(|mutant| {
            let outcome = outcomes.get(&mutant.key).filter(|outcome| !noticed(outcome))?;
            Some(json!({ "mutant": mutant.name, "outcome": outcome }))
        });
        println!("{}", json!({ "parts": parts, "left": left.collect::<Vec<_>>() }));
    } else {
        print(&parts);
    }
    let short = parts.iter().filter(|part| part.compiled() > 0 && part.share() < options.least);
    let short: Vec<_> = short.map(|part| format!("{}: {:.1} %", part.part, part.share())).collect();
    if !short.is_empty() {
        eprintln!("less than {} % killed: {}", options.least, short.join(", "));
        std::process::exit(1);
    }
}

fn noticed(outcome: &str) -> bool {
    !outcome.starts_with("survived") && outcome != "not reached"
}

fn read(results: &Path) -> BTreeMap<String, String> {
    let text = fs::read_to_string(results).unwrap_or_default();
    text.lines().filter_map(|line| line.split_once('\t')).map(|(key, outcome)| (key.into(), outcome.into())).collect()
}

fn write(results: &Path, outcomes: &BTreeMap<String, String>) {
    let lines: String = outcomes.iter().map(|(key, outcome)| format!("{key}\t{outcome}\n")).collect();
    fs::write(results, lines).expect("the copy");
}

/// A random order, by the last step of SplitMix64.
fn mixed(seed: u64, number: u32) -> u64 {
    let mut z = (seed << 32 | u64::from(number)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ z >> 31
}

/// A part of the library, or all of it.
#[derive(Serialize)]
struct Part {
    part: String,
    listed: usize,
    refused: usize,
    killed: usize,
    survived: usize,
    unreached: usize,
}

impl Part {
    fn compiled(&self) -> usize {
        self.killed + self.survived + self.unreached
    }

    /// Killed, of those that compile (%).
    fn share(&self) -> f64 {
        100.0 * self.killed as f64 / self.compiled().max(1) as f64
    }
}

/// Each part, and the sum of all.
fn parts(mutants: &[list::Mutant], outcomes: &BTreeMap<String, String>) -> Vec<Part> {
    let mut rows: BTreeMap<&str, Part> = BTreeMap::new();
    let part = |name: &str| Part { part: name.into(), listed: 0, refused: 0, killed: 0, survived: 0, unreached: 0 };
    let mut all = part("all");
    for mutant in mutants {
        let row = rows.entry(mutant.module()).or_insert_with_key(|name| part(name));
        let outcome = outcomes.get(&mutant.key).map_or("", String::as_str);
        for row in [row, &mut all] {
            row.listed += 1;
            row.refused += usize::from(outcome == "does not compile");
            row.killed += usize::from(outcome.starts_with("killed"));
            row.survived += usize::from(outcome.starts_with("survived"));
            row.unreached += usize::from(outcome == "not reached");
        }
    }
    rows.into_values().chain([all]).collect()
}

fn print(parts: &[Part]) {
    println!("| part | listed | judged | do not compile | killed | survived | not reached | killed |");
    println!("|---|---|---|---|---|---|---|---|");
    for row in parts {
        let Part { part, listed, refused, killed, survived, unreached } = row;
        let (judged, share) = (refused + row.compiled(), row.share());
        println!("| {part} | {listed} | {judged} | {refused} | {killed} | {survived} | {unreached} | {share:.1} % |");
    }
    if let Some(all) = parts.last() {
        let judged = parts.iter().filter(|part| part.compiled() > 0);
        let shares: Vec<_> = judged.map(|part| format!("{} {:.1} %", part.part, part.share())).collect();
        println!("measured: {} mutants that compile; killed: {}", all.compiled(), shares.join(", "));
    }
}
