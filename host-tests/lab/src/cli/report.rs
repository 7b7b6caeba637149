//! `cargo lab report`: every scene and every stiff case in one table and one file.

use std::path::PathBuf;
use std::thread;
use std::time::Instant;

use clap::Args;
use driveline_firmware::board::BOARDS;

use crate::stamp::Stamp;
use crate::survey::{Wanted, jobs, work};
use crate::survey::{survey_markdown, survey_table};
use cargo_driveline::cli::results::{Destination, check_writable};
use cargo_driveline::cli::setup::ready;
use cargo_driveline::cli::{Failure, Progress, say, say_json};
use driveline_qemu::setup::Need;

/// Run every scene in all its variants, and every stiff or extreme case, and write all tables in Markdown.
///
/// Installs what is missing (as `setup` does), builds the firmware that is not built yet, runs the closed loops side by
/// side on the cores, and writes a page of Markdown: errors beside the aims, instructions, flash and RAM, dynamic
/// factors, verdicts on every case. A failure is reported in its place and affects nothing else.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo lab report
  cargo lab report --scene hoist spindle
  cargo lab report --quick --markdown report/quick.md
  cargo lab report --markdown doc/makers/results.md
  cargo lab report --json > report.json")]
pub struct Report {
    /// Only these scenes, and no cases
    #[arg(long, value_name = "NAME", num_args = 1..)]
    scene: Vec<String>,
    /// Print everything that was measured as JSON, and no table
    #[arg(long)]
    pub json: bool,
    /// File of the page, in Markdown
    #[arg(long, value_name = "FILE", default_value = "report/report.md")]
    markdown: PathBuf,
    /// Two seconds of each scene, unproven: for trying out, not for figures to quote
    #[arg(long)]
    quick: bool,
}

impl Report {
    /// Runs it all, prints the table or JSON, writes the page.
    ///
    /// # Errors
    /// No such scene; a page that cannot be written; what could not be done, after the page is written.
    pub fn execute(&self) -> Result<(), Failure> {
        let wanted = Wanted::scenes(&self.scene).map_err(Failure::usage)?;
        let file = Destination::chosen("page", &self.markdown);
        check_writable(&[], [&file])?;
        ready(&Need::to_run(BOARDS))?;
        let began = Instant::now();
        let (jobs, mut survey) = jobs(&wanted, self.quick);
        survey.measured = Stamp::now().to_string();
        let progress = Progress::of(jobs.iter().map(|job| job.weight).sum());
        let threads = thread::available_parallelism().map_or(1, usize::from);
        let done = work(jobs, threads, &|text| progress.says(text), &|weight| progress.steps(weight));
        drop(progress);
        for outcome in done {
            match outcome {
                Ok(piece) => survey.add(piece),
                Err(failure) => survey.failures.push(failure),
            }
        }
        survey.seconds = began.elapsed().as_secs_f64();
        if self.json {
            say_json(&survey)?;
        } else {
            say(survey_table(&survey));
        }
        file.write_and_say(&survey_markdown(&survey), self.json)?;
        match survey.failures.as_slice() {
            [] => Ok(()),
            [first, rest @ ..] => {
                let others = if rest.is_empty() { String::new() } else { format!(", and {} more", rest.len()) };
                Err(Failure::failed(format!("{}, {}: {}{others}", first.place, first.job, first.reason)))
            }
        }
    }
}
