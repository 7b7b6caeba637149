//! The library's observer over a recording, in single precision and in fixed point, as it would run on the drive.

mod page;
mod run;
mod signals;
mod table;

pub use page::page;
pub use run::{Course, Design, OfReal, Replayed, replay};
pub use signals::{Between, Signals};
pub use table::{Summary, csv, summaries, table};
