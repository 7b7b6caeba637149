//! `cargo lab genset`: the gensets in QEMU, against the standards.

use std::path::PathBuf;

use clap::Args;

use crate::generator::{page, verdict};
use cargo_driveline::cli::results::{Destination, check_writable};
use cargo_driveline::cli::setup::ready;
use cargo_driveline::cli::{Failure, Progress, say, say_json};
use driveline_qemu::setup::Need;

/// Run the gensets' firmware in QEMU against their full plants, and give a verdict by ISO 8528-5 and NEMA SM 23.
///
/// Installs what is missing (as `setup` does), builds the firmware of every variant, runs its load steps with the
/// estimated load fed forward and without, then a fault on every input and every trip; prints tables and writes a page
/// with plots.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo lab genset
  cargo lab genset --variants f32/m4f/diesel --no-faults
  cargo lab genset --json > genset.json")]
pub struct Generator {
    /// Print {verdicts: [...], faults: [...], trips: [...]} and no table
    #[arg(long)]
    pub json: bool,
    /// File of the page
    #[arg(long, value_name = "PATH", default_value = "report/genset.html")]
    html: PathBuf,
    /// Only variants whose number/core/set/rate contains this text, as `fixed/m3` or `turbine`
    #[arg(long, value_name = "FILTER")]
    variants: Option<String>,
    /// Load steps only
    #[arg(long)]
    no_faults: bool,
}

impl Generator {
    /// Runs the sets, prints the verdict, writes the page.
    ///
    /// # Errors
    /// No such variant; what kept one from running; a page that cannot be written.
    pub fn execute(&self) -> Result<(), Failure> {
        let variants = verdict::variants(self.variants.as_deref());
        if variants.is_empty() {
            let filter = self.variants.as_deref().unwrap_or_default();
            let names = verdict::names().join(", ");
            return Err(Failure::usage(format!("no variant contains `{filter}`; there are {names}")));
        }
        let file = Destination::chosen("page", &self.html);
        check_writable(&[], [&file])?;
        ready(&Need::to_run(variants.iter().map(|one| &one.board)))?;
        let progress = Progress::of(verdict::steps(&variants, !self.no_faults));
        let verdicts = verdict::run_all(&variants, !self.no_faults, &|text| progress.says(text), &|| progress.step())
            .map_err(|error| Failure::failed(error.to_string()))?;
        drop(progress);
        let write = || file.write_and_say(&page::page(&verdicts), self.json);
        if self.json {
            say_json(&verdicts)?;
            return write();
        }
        let has = |set: &str| verdicts.verdicts.iter().any(|one| one.set == set);
        if has("diesel") {
            say(format_args!("diesel set, ISO 8528-5\n{}", page::diesel(&verdicts)));
        }
        if has("turbine") {
            say(format_args!("turbine set, NEMA SM 23\n{}", page::turbine(&verdicts)));
        }
        say(format_args!("load steps\n{}", page::steps(&verdicts)));
        if !verdicts.faults.is_empty() {
            say(format_args!("a fault on every input, diesel at half load\n{}", page::faults(&verdicts)));
        }
        if !verdicts.trips.is_empty() {
            say(format_args!("every trip, diesel\n{}", page::trips(&verdicts)));
        }
        write()
    }
}
