//! `cargo driveline backlash`: comparison of approaches to an observer with a gap.

use std::path::PathBuf;

use clap::Args;

use super::results::{Destination, check};
use super::{Failure, Progress, say, say_json};
use crate::backlash::Comparison;
use crate::backlash::backlash_page;

/// Compare approaches to an observer with backlash, over random reversals of six machines with the full solver.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo driveline backlash
  cargo driveline backlash --seconds 20 --seed 7
  cargo driveline backlash --json")]
pub struct Backlash {
    /// Seconds of each of the 24 runs, 1 to 1000
    #[arg(long, default_value_t = 6, value_parser = clap::value_parser!(u32).range(1..=1000))]
    seconds: u32,
    /// Seed of the random runs
    #[arg(long, default_value_t = 31)]
    seed: u64,
    /// File of the page [default: report/backlash.html]
    #[arg(long, value_name = "PATH")]
    html: Option<PathBuf>,
    /// Print JSON, and write a page only with --html
    #[arg(long)]
    pub json: bool,
}

impl Backlash {
    /// Runs the comparison and shows it.
    ///
    /// # Errors
    /// A page that cannot be written.
    pub fn execute(&self) -> Result<(), Failure> {
        let file = Destination::page_unless(self.json, self.html.as_deref(), "backlash");
        check(&[], &file)?;
        let bar = Progress::of(Comparison::COURSES as u64);
        let comparison = Comparison::run(f64::from(self.seconds), self.seed, |course| {
            bar.says(course);
            bar.step();
        })
        .map_err(|error| Failure::failed(error.to_string()))?;
        drop(bar);
        if self.json {
            say_json(&comparison)?;
        } else {
            say(comparison.table());
        }
        file.map_or(Ok(()), |file| file.write_and_say(&backlash_page(&comparison), self.json))
    }
}
