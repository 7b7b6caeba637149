//! `cargo driveline check`: everything that must hold before a commit, in order, up to the first failure.

mod cargo;
pub mod comparison;
mod step;
mod steps;

use std::time::{Duration, Instant};

use serde::Serialize;

pub use step::{Count, Step};
pub use steps::STEPS;

use step::{Failed, Voice};

/// What to check and how to say it.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// One JSON object a step on standard output, all else on standard error.
    pub json: bool,
    /// Only the step of this name, one of [`STEPS`].
    pub only: Option<String>,
}

/// A step that has run.
#[derive(Clone, Debug, Serialize)]
pub struct Done {
    /// Its name.
    pub step: &'static str,
    /// What it found.
    #[serde(flatten)]
    pub count: Count,
    /// Wall time, seconds.
    pub seconds: f64,
    /// What went wrong.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
    /// What to type to run it again.
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
        /// What it said.
        message: String,
        /// What to type.
        repeat: String,
    },
    /// No step has that name.
    #[error("no step is called `{0}`; there are {list}", list = STEPS.map(|step| step.name).join(", "))]
    NoSuchStep(String),
}

/// Runs the steps up to the first failure. Says each with its time, and at the end the closing line `N passed, N failed`.
pub fn run(options: &Options) -> Result<Vec<Done>, CheckError> {
    let voice = Voice { json: options.json };
    let chosen = |step: &&Step| options.only.as_ref().is_none_or(|only| only == step.name);
    let steps: Vec<_> = STEPS.iter().filter(chosen).collect();
    if let (Some(only), true) = (&options.only, steps.is_empty()) {
        return Err(CheckError::NoSuchStep(only.clone()));
    }
    let mut all = Vec::new();
    for step in steps {
        let done = once(step, &voice);
        let error = done.error.clone();
        all.push(done);
        if let Some(message) = error {
            close(&all, &voice);
            return Err(CheckError::Step { step: step.name, message, repeat: step.repeat.into() });
        }
    }
    close(&all, &voice);
    Ok(all)
}

fn once(step: &Step, voice: &Voice) -> Done {
    voice.say(&format!("== {}", step.name));
    let started = Instant::now();
    let result = (step.run)(voice);
    let seconds = (started.elapsed().as_secs_f64() * 1e3).round() / 1e3;
    let (count, error) = match result {
        Ok(count) => (count, None),
        Err(Failed { count, message }) => (count, Some(message)),
    };
    let verdict = if error.is_none() { "ok" } else { "FAILED" };
    let time = Duration::from_secs_f64(seconds);
    voice.say(&format!("== {}: {verdict}, {} passed, {time:.1?}", step.name, count.passed));
    let done = Done { step: step.name, count, seconds, error, repeat: step.repeat.into() };
    if voice.json {
        println!("{}", serde_json::to_string(&done).unwrap_or_default());
    }
    done
}

/// The closing line.
fn close(all: &[Done], voice: &Voice) {
    let passed: u64 = all.iter().map(|done| done.count.passed).sum();
    let failed: u64 = all.iter().map(|done| done.count.failed).sum();
    if voice.json {
        println!("{}", serde_json::json!({ "passed": passed, "failed": failed }));
    } else {
        println!("{passed} passed, {failed} failed");
    }
}
