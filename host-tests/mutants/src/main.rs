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

const HELP: &str = "Mutants of the tick path, all in one build, each behind a switch; which of them the tests notice.

It needs `cargo install cargo-mutants --locked`, and works in a copy of this clone.

options:
  --copy FOLDER      the copy [target/mutants of this crate]; `outcomes.tsv` in it has each mutant's outcome
  --minutes MINUTES  stop after so long: what was judged is a random sample [all]
  --seed NUMBER      order of the mutants [1]
  --longest SECONDS  leave out tests that take longer, alone [1]
  --file PREFIX      mutants of files that begin with it [src/]
  --quick            the tests of the library's own package alone, without the host's: a build of minutes
  --again            those that no test noticed the last time";

struct Options {
    copy: PathBuf,
    minutes: f64,
    seed: u64,
    longest: f64,
    file: String,
    quick: bool,
    again: bool,
}

fn options(root: &Path) -> Options {
    let copy = root.join("host-tests/mutants/target/mutants");
    let mut options = Options {
        copy,
        minutes: f64::INFINITY,
        seed: 1,
        longest: 1.0,
        file: "src/".into(),
        quick: false,
        again: false,
    };
    let mut arguments = env::args().skip(1);
    while let Some(name) = arguments.next() {
        let mut value = || arguments.next().unwrap_or_else(|| stop(&format!("{name} needs a value")));
        let number = |text: String| text.parse().unwrap_or_else(|_| stop(&format!("{text} is not a number")));
        match name.as_str() {
            "--copy" => options.copy = value().into(),
            "--minutes" => options.minutes = number(value()),
            "--seed" => options.seed = number(value()) as u64,
            "--longest" => options.longest = number(value()),
            "--file" => options.file = value(),
            "--quick" => options.quick = true,
            "--again" => options.again = true,
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
    fs::create_dir_all(&options.copy).expect("the copy");
    let mutants = list::list(&root);
    let switched = build::switched(&root, &options.copy, &mutants);
    let results = options.copy.join("outcomes.tsv");
    let before = read(&results);
    let programs = build::programs(&options.copy, options.quick);
    let tests = run::tests(&programs, Duration::from_secs_f64(options.longest), &options.copy.join("reached"));

    let mut order: Vec<_> = mutants.iter().filter(|mutant| mutant.file.starts_with(&options.file)).collect();
    order.retain(|mutant| !options.again || before.get(&mutant.key).is_some_and(|outcome| !noticed(outcome)));
    order.sort_by_key(|mutant| mixed(options.seed, mutant.number));
    let start = Instant::now();
    let mut outcomes = if options.again { before } else { BTreeMap::new() };
    let mut file = fs::File::create(options.copy.join("progress.tsv")).expect("the copy");
    for mutant in order {
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
    let lines: String = outcomes.iter().map(|(key, outcome)| format!("{key}\t{outcome}\n")).collect();
    fs::write(results, lines).expect("the copy");
    print(&mutants, &outcomes);
}

fn noticed(outcome: &str) -> bool {
    !outcome.starts_with("survived") && outcome != "not reached"
}

fn read(results: &Path) -> BTreeMap<String, String> {
    let text = fs::read_to_string(results).unwrap_or_default();
    text.lines().filter_map(|line| line.split_once('\t')).map(|(key, outcome)| (key.into(), outcome.into())).collect()
}

/// A random order, by the last step of SplitMix64.
fn mixed(seed: u64, number: u32) -> u64 {
    let mut z = (seed << 32 | u64::from(number)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ z >> 31
}

fn print(mutants: &[list::Mutant], outcomes: &BTreeMap<String, String>) {
    const COLUMNS: [&str; 4] = ["does not compile", "killed", "survived", "not reached"];
    let mut rows: BTreeMap<&str, [usize; 5]> = BTreeMap::new();
    for mutant in mutants {
        let row = rows.entry(mutant.module()).or_default();
        row[4] += 1;
        let outcome = outcomes.get(&mutant.key).map_or("", String::as_str);
        if let Some(column) = COLUMNS.iter().position(|column| outcome.starts_with(column)) {
            row[column] += 1;
        }
    }
    println!(
        "| part | listed | judged | do not compile | killed | survived | not reached | killed, of those that compile |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    let mut sum = [0; 5];
    for (part, row) in &rows {
        for (sum, count) in sum.iter_mut().zip(row) {
            *sum += count;
        }
        line(&format!("`{part}`"), row);
    }
    line("all", &sum);
}

fn line(part: &str, [refused, killed, survived, unreached, listed]: &[usize; 5]) {
    let judged = refused + killed + survived + unreached;
    let share = 100.0 * *killed as f64 / (killed + survived + unreached).max(1) as f64;
    println!("| {part} | {listed} | {judged} | {refused} | {killed} | {survived} | {unreached} | {share:.1} % |");
}
