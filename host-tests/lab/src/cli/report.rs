//! `cargo lab report`: every scene in one table and one file.

use std::path::PathBuf;

use clap::Args;
use driveline_firmware::board::BOARDS;

use crate::stamp::Stamp;
use crate::survey::{markdown, names, overview, survey};
use cargo_driveline::cli::results::{Destination, check_writable};
use cargo_driveline::cli::setup::ready;
use cargo_driveline::cli::{Failure, Progress, say, say_json};
use driveline_qemu::setup::Need;

/// Run every scene in all its variants, and write all tables in Markdown.
///
/// Installs what is missing (as `setup` does), builds the firmware that is not built yet, runs the closed loops side by
/// side on the cores, and writes a page of Markdown: errors beside the aims, instructions, flash and RAM. A failure is
/// reported in its place and affects nothing else.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo lab report
  cargo lab report --scene hoist spindle
  cargo lab report --quick --markdown report/quick.md
  cargo lab report --markdown doc/makers/results.md
  cargo lab report --json > report.json")]
pub struct Report {
    /// Only these scenes
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
        let all = names();
        if let Some(unknown) = self.scene.iter().find(|name| !all.contains(&name.as_str())) {
            let all: Vec<String> = all.iter().map(|name| format!("`{name}`")).collect();
            return Err(Failure::usage(format!("there is no scene `{unknown}`; there are {}", all.join(", "))));
        }
        let wanted = |name: &&str| self.scene.is_empty() || self.scene.iter().any(|wanted| wanted == name);
        let wanted: Vec<&str> = all.into_iter().filter(wanted).collect();
        let file = Destination::chosen("page", &self.markdown);
        check_writable(&[], [&file])?;
        ready(&Need::to_run(BOARDS))?;
        let progress = Progress::of(wanted.len() as u64);
        let mut survey = survey(&wanted, self.quick, &|text| progress.says(text), &|| progress.step());
        survey.measured = Stamp::now().to_string();
        drop(progress);
        if self.json {
            say_json(&survey)?;
        } else {
            say(overview(&survey));
        }
        file.write_and_say(&markdown(&survey), self.json)?;
        match survey.failures.as_slice() {
            [] => Ok(()),
            [(scene, reason), ..] => Err(Failure::failed(format!("{scene}: {reason}"))),
        }
    }
}
