//! The report of a run: a page with plots for people, a table for the terminal, JSON for programs.
//!
//! The page is one file that opens from the disk: style and plots stand in it, and nothing is fetched. Plots are SVG
//! written by the module `svg`, coloured by the page's style, so that they follow the reader's light or dark theme.
//!
//! | term | meaning |
//! |---|---|
//! | variant | number type, core, observer and rate of a drive |
//! | error | estimate less truth, as a fraction of the peak (torque) or of the rated speed |
//! | front | the variants that no other beats in both cost and error |
//!
//! ```
//! use driveline_report::Report;
//!
//! let page = Report { scene: "hoist".into(), ..Report::default() }.page();
//! assert!(page.starts_with("<!doctype html>"));
//! ```

pub mod chart;
pub mod format;
mod page;
mod report;
mod results;
mod sample;
mod sheet;
mod svg;
mod table;
mod trajectory;

pub use report::Report;
pub use results::{Budget, Deviation, Fact, Instructions, Variant, fact};
pub use sample::{SAMPLES, Sample, Sampled, samples_table};
pub use sheet::{Arrangement, Figure, Key, Section, Sheet};
pub use table::{Table, variants_table};
pub use trajectory::{Mark, Signal, Trajectory};
