//! The backlash observer on random runs of the full solver: machines, runs, and the error of the estimates.
//!
//! | term | meaning |
//! |---|---|
//! | case | a two-mass machine of 15 Hz with a gap of 10 mrad, and its rated torque |
//! | course | a recorded run: what the sensors said in every tick, and what was true |
//! | error | of the shaft torque over a course, rms, of its peak |
//!
//! Sensors: 2048 lines read as 8192 counts, a torque that is known to 1 % of rated in a tick, 10,000 ticks a second.

mod case;
mod run;
mod score;

pub use case::{Case, GAP, RATE_HZ, cases};
pub use run::{Course, Kind, Rig};
pub use score::{Library, error};
