//! The library over a recording, as it would run on the drive: the observer in single precision and in fixed point, the
//! speed's fluctuation from an angle or from a toothed wheel, the phasors of a vibration.

pub mod fluctuation;
mod page;
pub mod phasors;
mod run;
mod signals;
mod table;
pub mod wheel;
pub mod window;

pub use page::page;
pub use run::{Course, Design, OfReal, Replayed, replay};
pub use signals::{Between, Signals};
pub use table::{Summary, csv, summaries, table};
