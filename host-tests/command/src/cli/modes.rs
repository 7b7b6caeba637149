//! `cargo driveline modes`: natural vibrations and reduction of a machine.

mod campbell;
mod chain;
mod damped;
mod damper;
mod engine;
mod figures;
mod network;
mod page;
mod response;
mod starts;
mod tables;
mod train;

use std::path::PathBuf;

use clap::Args;

pub use chain::Vibration;

use page::page;
use tables::tables;
use train::TrainVibration;

use super::results::{Destination, check};
use super::{Failure, Progress, say, say_json};
use crate::machine_file::{is_train, parse_for_modes, parse_train_for_modes, slug, text};
use driveline_report::Section;

/// Find natural frequencies and shapes of a machine, its two-mass reductions, and the sensitivity to each part.
///
/// A chain of elements, with its branches, is referred to the motor's shaft; a train of coordinates and links stays as
/// it is. With `[running]` and `[[excitation]]` in the file, critical speeds are listed and drawn, and those within 10
/// % of the running range flagged. The page with the plots opens in any browser.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo driveline example hoist > hoist.toml
  cargo driveline modes hoist.toml
  cargo driveline modes my.toml --html my.html
  cargo driveline modes my.toml --json")]
pub struct Modes {
    /// The machine: a TOML file of elements from the motor to the load
    file: PathBuf,
    /// File of the page [default: report/NAME-modes.html]
    #[arg(long, value_name = "PATH")]
    html: Option<PathBuf>,
    /// Print JSON, and write a page only with --html
    #[arg(long)]
    pub json: bool,
}

impl Modes {
    /// Reads the machine and shows its vibrations.
    ///
    /// # Errors
    /// A machine file with a fault; a page that cannot be written.
    pub fn execute(&self) -> Result<(), Failure> {
        // read once: a pipe gives its text only once
        let (name, text) = text(&self.file, "a machine file")?;
        if is_train(&text) {
            let file = parse_train_for_modes(&name, &text)?;
            let vibration = Progress::during(|| TrainVibration::of(&file), &format!("{name}: finding the modes"))?;
            return self.show(&file.name, || vibration.page(&file), &vibration, vibration.tables());
        }
        let machine = parse_for_modes(&name, &text)?;
        let vibration = Progress::during(|| Vibration::of(&machine), &format!("{name}: finding the modes"))?;
        self.show(&machine.name, || page(&machine, &vibration), &vibration, tables(&vibration))
    }

    fn show(
        &self,
        name: &str,
        page: impl FnOnce() -> String,
        vibration: &impl serde::Serialize,
        tables: Vec<Section>,
    ) -> Result<(), Failure> {
        let file = Destination::page_unless(self.json, self.html.as_deref(), &format!("{}-modes", slug(name)));
        check(&[&self.file], &file)?;
        if self.json {
            say_json(vibration)?;
        } else {
            tables.into_iter().for_each(say);
        }
        file.map_or(Ok(()), |file| file.write_and_say(&page(), self.json))
    }
}
