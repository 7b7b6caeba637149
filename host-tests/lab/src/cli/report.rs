//! `cargo lab report`: every scene and every stiff case on one page.

use std::path::PathBuf;
use std::thread;
use std::time::Instant;

use clap::Args;
use driveline_firmware::board::BOARDS;

use crate::stamp::Stamp;
use crate::survey::{Wanted, jobs, work};
use crate::survey::{survey_markdown, survey_page, survey_table};
use cargo_driveline::cli::results::{Destination, all, check_writable};
use cargo_driveline::cli::setup::ready;
use cargo_driveline::cli::{Failure, Progress, say, say_json};
use driveline_qemu::setup::Need;

/// Run every scene in all its variants, and every stiff or extreme case, and put it all on one page.
///
/// Installs what is missing (as `setup` does), builds the firmware that is not built yet, runs the closed loops side by
/// side on the cores, and writes a page: errors beside the aims and why an aim is missed, error against instructions,
/// flash and RAM, dynamic factors, verdicts on every case. A failure is reported in its place and affects nothing else.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo lab report
  cargo lab report --scene hoist spindle
  cargo lab report --quick --html report/quick.html
  cargo lab report --markdown doc/makers/results.md
  cargo lab report --json > report.json")]
pub struct Report {
    /// Only these scenes, and no cases
    #[arg(long, value_name = "NAME", num_args = 1..)]
    scene: Vec<String>,
    /// Print everything that was measured as JSON, and no table
    #[arg(long)]
    pub json: bool,
    /// File of the page
    #[arg(long, value_name = "FILE", default_value = "report/report.html")]
    html: PathBuf,
    /// Where the tables go as Markdown, for the book
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
    /// Two seconds of each scene, unproven, and a coarse sweep: for trying out, not for figures to quote
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
        let file = Destination::chosen("page", &self.html);
        let markdown = self.markdown.as_ref().map(|path| Destination::chosen("tables", path));
        check_writable(&[], [Some(&file), markdown.as_ref()].into_iter().flatten())?;
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
        all([
            file.write_and_say(&survey_page(&survey), self.json),
            markdown.map_or(Ok(()), |file| file.write_and_say(&survey_markdown(&survey), self.json)),
        ])?;
        match survey.failures.as_slice() {
            [] => Ok(()),
            [first, rest @ ..] => {
                let others = if rest.is_empty() { String::new() } else { format!(", and {} more", rest.len()) };
                Err(Failure::failed(format!("{}, {}: {}{others}", first.place, first.job, first.reason)))
            }
        }
    }
}
