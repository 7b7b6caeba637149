//! Cargo or another program as a step: its exit code, or the sum of its test results.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};

use super::step::SKIPPED;
use super::{Count, Failed, Voice};
use driveline_qemu::children::{Folder, Running};
use driveline_qemu::clone::workspace;
use driveline_qemu::setup;

/// Runs cargo as one check.
pub fn passes(arguments: &[&str], voice: &Voice) -> Result<Count, Failed> {
    program_passes(&setup::cargo(), arguments, voice)
}

/// Runs any program as one check.
pub fn program_passes(program: &OsStr, arguments: &[&str], voice: &Voice) -> Result<Count, Failed> {
    let (success, _) = run(program, arguments, voice)?;
    if success { Ok(Count { passed: 1, ..Count::default() }) } else { Err(Failed::whole(refused(program, arguments))) }
}

/// Runs `cargo test` and counts what its runners report, which is passed on as it comes.
pub fn tests(arguments: &[&str], voice: &Voice) -> Result<Count, Failed> {
    let cargo = setup::cargo();
    let (success, mut count) = run(&cargo, arguments, voice)?;
    if success {
        return Ok(count);
    }
    // a test that does not compile reports no result
    count.failed = count.failed.max(1);
    Err(Failed { count, message: refused(&cargo, arguments) })
}

/// Runs the tests that are ignored for their length, of one program, by name. A name that no test has is a failure.
pub fn ignored_tests(package: &str, program: &str, names: &[&str], voice: &Voice) -> Result<Count, Failed> {
    let (package, program) = (format!("--package={package}"), format!("--test={program}"));
    let arguments = ["test", &package, &program, "--", "--ignored", "--nocapture"];
    let count = tests(&[&arguments[..], names].concat(), voice)?;
    if count.passed + count.skipped < names.len() as u64 {
        return Err(Failed { count, message: format!("one of {} is no test", names.join(", ")) });
    }
    Ok(count)
}

fn run(program: &OsStr, arguments: &[&str], voice: &Voice) -> Result<(bool, Count), Failed> {
    let failed = |error: std::io::Error| Failed::whole(format!("{}: {error}", line(program, arguments)));
    let root = workspace().map_err(Failed::whole)?;
    let mut command = Command::new(program);
    command.args(arguments).current_dir(root).stdin(Stdio::null()).stdout(Stdio::piped());
    if arguments.iter().any(|argument| argument.starts_with("--target=")) {
        // these would replace the linker script that .cargo/config.toml names
        command.env_remove("RUSTFLAGS").env_remove("CARGO_ENCODED_RUSTFLAGS");
    }
    // what the compiler and the tests leave when they are stopped goes with the folder
    let folder = Folder::make().map_err(failed)?;
    let mut child = Running::start(command.env("TMPDIR", folder.path())).map_err(failed)?;
    let mut counter = Counter::default();
    for line in child.stdout.take().into_iter().flat_map(|stdout| BufReader::new(stdout).split(b'\n')) {
        let line = String::from_utf8_lossy(&line.map_err(failed)?).into_owned();
        voice.say(&line);
        counter.take(&line);
    }
    Ok((child.wait().map_err(failed)?.success(), counter.count))
}

/// Counts what runners of tests print.
#[derive(Default)]
struct Counter {
    count: Count,
    /// Names of the present runner's tests that were skipped; one may say so several times.
    skipped: BTreeSet<String>,
}

impl Counter {
    fn take(&mut self, line: &str) {
        let test = line.split_once(SKIPPED).and_then(|(_, skipped)| skipped.split_once(": "));
        self.skipped.extend(test.map(|(name, _)| name.to_owned()));
        if let Some((passed, failed)) = result(line) {
            let skipped = std::mem::take(&mut self.skipped).len() as u64;
            self.count.passed += passed.saturating_sub(skipped);
            self.count.failed += failed;
            self.count.skipped += skipped;
        }
    }
}

/// Passed and failed in a runner's own summary, `test result: ok. 3 passed; 0 failed; ..`.
fn result(line: &str) -> Option<(u64, u64)> {
    let (_, counts) = line.trim_start().strip_prefix("test result: ")?.split_once(". ")?;
    let number =
        |what: &str| counts.split("; ").find_map(|part| part.trim().strip_suffix(what)?.trim_end().parse().ok());
    Some((number("passed")?, number("failed")?))
}

fn refused(program: &OsStr, arguments: &[&str]) -> String {
    format!("{} did not pass", line(program, arguments))
}

/// What to type.
fn line(program: &OsStr, arguments: &[&str]) -> String {
    let name = Path::new(program).file_name().unwrap_or(program);
    format!("{} {}", name.display(), arguments.join(" "))
}
