//! The report of a run: a page with plots for people, a table for the terminal, JSON for programs.
//!
//! The page is one file that opens from the disk: style and plots stand in it, and nothing is fetched. Plots are SVG
//! written by [`svg`], coloured by the page's style, so that they follow the reader's light or dark theme.
//!
//! | term | meaning |
//! |---|---|
//! | variant | number type, core, observer and rate of a drive |
//! | error | estimate less truth, as a fraction of the peak (torque) or of the rated speed |
//! | front | the variants that no other beats in both cost and error |
//! | composition | the parts a drive is made of, for the table of flash and RAM |
//!
//! ```
//! use driveline_report::Report;
//!
//! let page = Report { scene: "hoist".into(), ..Report::default() }.page();
//! assert!(page.starts_with("<!doctype html>"));
//! ```

mod balance_page;
pub mod chart;
pub mod format;
mod modes_page;
pub mod page;
mod plots_page;
mod results;
mod sheet;
mod simulation_page;
pub mod svg;
mod sweep;
mod table;
mod trajectory;

pub use balance_page::{BalancePage, PolarFigure, PolarKey};
pub use modes_page::{MachinePage, ModeFigure};
pub use plots_page::PlotsPage;
pub use results::{Budget, Comparison, Composition, Deviation, Fact, Instructions, Variant};
pub use sheet::{Figure, Sheet};
pub use simulation_page::SimulationPage;
pub use sweep::{Slice, Sweep, SweepPoint};
pub use table::{Table, variants_table};
pub use trajectory::{Mark, Signal, Trajectory};

use std::path::Path;

use serde::{Deserialize, Serialize};

/// Everything that a run has to say.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Report {
    /// The scene's name: `hoist`.
    pub scene: String,
    /// What was run, in a sentence or two.
    pub summary: String,
    /// What the machine and the run are.
    pub facts: Vec<Fact>,
    /// Every variant, in the order of the table.
    pub variants: Vec<Variant>,
    /// Courses over time; the first variant and situation are shown first.
    pub trajectories: Vec<Trajectory>,
    /// The observer with other steps, computed on the host.
    pub comparisons: Vec<Comparison>,
    /// Sweeps over machines and rates.
    pub sweeps: Vec<Sweep>,
    /// Flash and RAM by composition.
    pub compositions: Vec<Composition>,
    /// Budgets and what was measured against them.
    pub budgets: Vec<Budget>,
    /// What the reader should know, a sentence each.
    pub notes: Vec<String>,
}

impl Report {
    /// The page as HTML. Long series are thinned (peaks kept) so that it stays under 3 MB.
    pub fn page(&self) -> String {
        page::page(self)
    }

    /// Writes the page, and the folder it stands in where that is missing.
    ///
    /// # Errors
    /// What the file system says.
    pub fn write(&self, path: &Path) -> std::io::Result<()> {
        write_page(path, &self.page())
    }

    /// What `run --json` prints: `{scene, variants}`.
    pub fn json(&self) -> serde_json::Value {
        serde_json::json!({ "scene": self.scene, "variants": self.variants })
    }
}

/// Finds out before a long run whether a page can be written; what stands there is left alone, and the folder is made where it is missing.
///
/// # Errors
/// What the file system says.
pub fn writable(path: &Path) -> std::io::Result<()> {
    make_folder_of(path)?;
    let stood = path.exists();
    std::fs::OpenOptions::new().append(true).create(true).open(path)?;
    if stood { Ok(()) } else { std::fs::remove_file(path) }
}

fn make_folder_of(path: &Path) -> std::io::Result<()> {
    match path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        Some(folder) => std::fs::create_dir_all(folder),
        None => Ok(()),
    }
}

/// Writes a page, and the folder it stands in where that is missing.
///
/// # Errors
/// What the file system says.
pub fn write_page(path: &Path, page: &str) -> std::io::Result<()> {
    make_folder_of(path)?;
    std::fs::write(path, page)
}
