//! The library over a recording, as it would run on the drive: the observer in single precision and in fixed point, the
//! toothed wheel with its ripple, the phasors of a vibration.

mod page;
pub mod phasors;
mod run;
mod signals;
mod table;
pub mod wheel;

pub use page::page;
pub use run::{Course, Design, OfReal, Replayed, replay};
pub use signals::{Between, Signals};
pub use table::{Summary, csv, summaries, table};
