//! Which mutants the tests notice.

use std::collections::{BTreeMap, HashSet};
use std::fmt::{self, Display, Formatter};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::build::Program;

/// A test of one of the programs.
pub struct Test {
    pub name: String,
    program: Program,
    time: Duration,
    reached: HashSet<u32>,
}

pub enum Outcome {
    /// Noticed by this test, or by one of those after it that ran with it.
    Killed(String),
    /// These tests took more than four times as long.
    Slowed(String),
    /// Noticed by none of so many tests that reach it.
    Survived(usize),
    /// No test reaches it at run time.
    Unreached,
}

impl Display for Outcome {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Outcome::Killed(test) => write!(f, "killed by {test}"),
            Outcome::Slowed(test) => write!(f, "killed by the time of {test}"),
            Outcome::Survived(tests) => write!(f, "survived {tests} tests"),
            Outcome::Unreached => write!(f, "not reached"),
        }
    }
}

/// The tests of the programs, each run alone, without those that take longer than `longest` or need a panic.
pub fn tests(programs: &[Program], longest: Duration, scratch: &Path) -> Vec<Test> {
    let mut tests = vec![];
    let mut left_out = vec![];
    for program in programs {
        let listed =
            Command::new(&program.path).args(["--list", "--format", "terse"]).output().expect("a test program");
        for line in String::from_utf8_lossy(&listed.stdout).lines() {
            let Some(name) = line.strip_suffix(": test") else { continue };
            let _ = fs::remove_file(scratch);
            let start = Instant::now();
            let (program, name) = (program.clone(), name.to_owned());
            let passed = run(&program, &[&name], "reached", scratch, longest) == Some(true);
            let time = start.elapsed();
            let numbers = fs::read_to_string(scratch).unwrap_or_default();
            let reached: HashSet<u32> = numbers.split_whitespace().filter_map(|number| number.parse().ok()).collect();
            if !passed {
                left_out.push(format!("{name} ({time:.1?})"));
            } else if !reached.is_empty() {
                tests.push(Test { name, program, time, reached });
            }
        }
    }
    eprintln!("{} tests reach a mutant; left out: {}", tests.len(), left_out.join(", "));
    tests.sort_by_key(|test| test.time);
    tests
}

/// Runs the tests that reach the mutant until one notices it, the quickest first, in groups of growing time.
pub fn judge(number: u32, tests: &[Test]) -> Outcome {
    let reaching: Vec<_> = tests.iter().filter(|test| test.reached.contains(&number)).collect();
    if reaching.is_empty() {
        return Outcome::Unreached;
    }
    let mut groups: BTreeMap<(u32, &Program), Vec<&Test>> = BTreeMap::new();
    for test in &reaching {
        let class = test.time.as_millis().max(20).ilog2();
        groups.entry((class, &test.program)).or_default().push(test);
    }
    for ((_, program), tests) in groups {
        let names: Vec<_> = tests.iter().map(|test| test.name.as_str()).collect();
        let limit = Duration::from_secs(3) + 4 * tests.iter().map(|test| test.time).sum::<Duration>();
        match run(program, &names, &number.to_string(), Path::new(""), limit) {
            Some(true) => {}
            Some(false) => return Outcome::Killed(tests[0].name.clone()),
            None => return Outcome::Slowed(tests[0].name.clone()),
        }
    }
    Outcome::Survived(reaching.len())
}

/// Whether these tests pass; `None` after `limit`.
fn run(program: &Program, names: &[&str], mutant: &str, reached: &Path, limit: Duration) -> Option<bool> {
    let mut command = Command::new(&program.path);
    command.current_dir(&program.folder).args(["--exact", "--test-threads", "1", "--quiet"]).args(names);
    command.env("MUTANT", mutant).env("MUTANTS_REACHED", reached);
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let mut child = command.spawn().expect("a test program");
    let start = Instant::now();
    loop {
        if let Some(status) = child.try_wait().expect("a child") {
            return Some(status.success());
        }
        if start.elapsed() > limit {
            let _ = child.kill();
            let _ = child.wait();
            return None;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
}
