//! The command and its arguments.

use std::path::PathBuf;

use clap::Args;
use driveline_report::Sheet;
use serde::Serialize;

use super::{Fault, amplitudes, outcome, page, said};
use crate::cli::results::{Destination, check};
use crate::cli::{Failure, say, say_json};
use crate::machine_file::balance::{BalanceFile, Measured, read};
use crate::machine_file::slug;

/// Find correction weights from the readings of a rotor's runs, the predicted residual, and the grade; the page has
/// polar plots.
///
/// The file has the planes, the sensors, a baseline and a trial run for each plane, with phases in degrees.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo driveline example fan-balance > fan-balance.toml
  cargo driveline balancing fan-balance.toml
  cargo driveline balancing my.toml --html my.html
  cargo driveline balancing my.toml --json")]
pub struct Balance {
    /// The readings: a TOML file
    file: PathBuf,
    /// File of the page [default: report/NAME-balancing.html]
    #[arg(long, value_name = "PATH")]
    html: Option<PathBuf>,
    /// Print JSON, and write a page only with --html
    #[arg(long)]
    pub json: bool,
}

impl Balance {
    /// Reads the file and shows the weights.
    ///
    /// # Errors
    /// A file with a fault; readings that no weights follow from; a page that cannot be written.
    pub fn execute(&self) -> Result<(), Failure> {
        let file = read(&self.file)?;
        if let Measured::Amplitudes { baseline, found } = &file.measured {
            let found = amplitudes::outcome(&file, *baseline, found).map_err(|fault| self.said(fault))?;
            return self.show(&file, &found, &found.said(), || found.page());
        }
        let outcome = outcome(&file).map_err(|fault| self.said(fault))?;
        self.show(&file, &outcome, &said(&outcome), || page(&outcome))
    }

    fn said(&self, fault: Fault) -> Failure {
        match fault {
            Fault::Placed(diagnostic) => diagnostic.into(),
            Fault::Refused(refusal) => Failure::failed(format!("{}: {refusal}", self.file.display())),
        }
    }

    /// Prints JSON or what there is to say, and writes the page.
    fn show(
        &self,
        file: &BalanceFile,
        outcome: &impl Serialize,
        said: &str,
        page: impl FnOnce() -> Sheet,
    ) -> Result<(), Failure> {
        let name = format!("{}-balancing", slug(&file.name));
        let file = Destination::page_unless(self.json, self.html.as_deref(), &name);
        check(&[&self.file], &file)?;
        if self.json {
            say_json(outcome)?;
        } else {
            say(said);
        }
        file.map_or(Ok(()), |file| file.write_and_say(&page().page(), self.json))
    }
}
