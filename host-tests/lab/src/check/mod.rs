//! `cargo lab check`: everything that must hold before a commit, in order, up to the first failure; the long runs
//! on demand, all of them.

mod cargo;
mod clock;
pub mod comparison;
mod each;
mod long;
mod pages;
mod step;
mod steps;

use driveline_report::Table;
use serde::Serialize;

pub use long::LONG;
pub use step::{Count, Step, skip};
pub use steps::STEPS;

use clock::{Clock, Took};
use step::{Failed, Voice};

/// Options of a check.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// One JSON object a step on standard output, all else on standard error.
    pub json: bool,
    /// The long runs, [`LONG`], in place of [`STEPS`]; a failure does not stop the others.
    pub long: bool,
    /// Only the step of this name.
    pub only: Option<String>,
}

/// A step that has run.
#[derive(Clone, Debug, Serialize)]
pub struct Done {
    /// Its name.
    pub step: &'static str,
    /// Its findings.
    #[serde(flatten)]
    pub count: Count,
    /// Its figures, as sentences.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub figures: Vec<String>,
    /// How long it took.
    #[serde(flatten)]
    pub took: Took,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
    /// Command to run it again.
    pub repeat: String,
}

/// Why the check failed.
#[derive(Debug, thiserror::Error)]
pub enum CheckError {
    /// A step failed.
    #[error("{step} failed: {message}\nto repeat: {repeat}")]
    Step {
        /// Its name.
        step: &'static str,
        /// Its output.
        message: String,
        /// Command to type.
        repeat: String,
    },
    /// No step has that name.
    #[error("no {0} is called `{1}`; there are {2}")]
    NoSuchStep(&'static str, String, String),
    /// The long runs that failed.
    #[error("failed: {0}")]
    Long(String),
}

/// Runs the steps up to the first failure, or all long runs. Says each with its time, and at the end the closing line
/// `N passed, N failed`, with `, N skipped` where tests were skipped.
///
/// # Errors
/// No such step, a step that failed.
pub fn run(options: &Options) -> Result<Vec<Done>, CheckError> {
    let voice = Voice::new(options.json);
    let (kind, all): (_, &[Step]) = if options.long { ("long step", &LONG) } else { ("step", &STEPS) };
    let chosen = |step: &&Step| options.only.as_ref().is_none_or(|only| only == step.name);
    let steps: Vec<_> = all.iter().filter(chosen).collect();
    if let (Some(only), true) = (&options.only, steps.is_empty()) {
        let names: Vec<_> = all.iter().map(|step| step.name).collect();
        return Err(CheckError::NoSuchStep(kind, only.clone(), names.join(", ")));
    }
    let (mut all, mut failed) = (Vec::new(), Vec::new());
    for step in steps {
        let done = once(step, &voice);
        let error = done.error.clone();
        all.push(done);
        let Some(message) = error else { continue };
        if !options.long {
            close(&all, &voice);
            return Err(CheckError::Step { step: step.name, message, repeat: step.repeat.into() });
        }
        failed.push(format!("{}: {message}\nto repeat: {}", step.name, step.repeat));
    }
    close(&all, &voice);
    if failed.is_empty() { Ok(all) } else { Err(CheckError::Long(failed.join("\n"))) }
}

fn once(step: &Step, voice: &Voice) -> Done {
    voice.say(&format!("== {}: {}", step.name, step.content));
    let clock = Clock::start();
    let result = (step.run)(voice);
    let took = clock.took();
    let (count, error) = match result {
        Ok(count) => (count, None),
        Err(Failed { count, message }) => (count, Some(message)),
    };
    let verdict = if error.is_none() { "ok" } else { "FAILED" };
    voice.say(&format!("== {}: {verdict}, {} passed, {:.1} s", step.name, count.passed, took.seconds));
    let figures = voice.figures();
    let done = Done { step: step.name, count, figures, took, error, repeat: step.repeat.into() };
    if voice.json {
        println!("{}", serde_json::to_string(&done).unwrap_or_default());
    }
    done
}

/// The steps with what they took, and the closing line.
fn close(all: &[Done], voice: &Voice) {
    let Count { passed, failed, skipped } = sum(all);
    voice.say(times(all).to_string().trim_end());
    if voice.json {
        println!("{}", serde_json::json!({ "passed": passed, "failed": failed, "skipped": skipped }));
    } else {
        println!("{}", closing(sum(all)));
    }
}

/// The closing line.
fn closing(Count { passed, failed, skipped }: Count) -> String {
    let skipped = if skipped == 0 { String::new() } else { format!(", {skipped} skipped") };
    format!("{passed} passed, {failed} failed{skipped}")
}

fn sum(all: &[Done]) -> Count {
    all.iter().fold(Count::default(), |sum, Done { count, .. }| Count {
        passed: sum.passed + count.passed,
        failed: sum.failed + count.failed,
        skipped: sum.skipped + count.skipped,
    })
}

/// What each step took, and their sum.
fn times(all: &[Done]) -> Table {
    let mut table = Table::new(["step", "passed", "failed", "skipped", "wall s", "processor s"]);
    let mut row = |name: &str, Count { passed, failed, skipped }, took: Took| {
        let processor = took.processor_seconds.map_or_else(String::new, |seconds| format!("{seconds:.1}"));
        let seconds = format!("{:.1}", took.seconds);
        let counts = [passed, failed, skipped].map(|count| count.to_string());
        table.row([name.to_owned()].into_iter().chain(counts).chain([seconds, processor]));
    };
    for done in all {
        row(done.step, done.count, done.took);
    }
    let seconds = all.iter().map(|done| done.took.seconds).sum();
    let processor_seconds = all.iter().map(|done| done.took.processor_seconds).sum();
    row("all", sum(all), Took { seconds, processor_seconds });
    table
}
