//! Fatigue: cycles of the shaft torque by rainflow counting, and the damage that they do.
//!
//! The torque is sorted into classes of equal width, which it leaves by a quarter of one: smaller reversals are none. A
//! tick looks for a reversal; without one it does one step of the four-point method. The end of a cycle may close many
//! others, so its work is spread over the ticks. Reversals wait in a queue until then. Damage, divisions and powers are
//! left to the time between the ticks.
//!
//! The count starts at zero torque, as a drive does: at rest, without torque in its shaft.
//!
//! - **reversal**: largest or smallest torque between two smaller or larger ones; N m
//! - **four-point method**: of four reversals in a row the middle two are a cycle where their range is in that of the
//!   outer ones; they are counted and removed [DIN 45667; ASTM E1049 counts the same cycles]
//! - **residue**: reversals that close no cycle yet: ranges that grow, then shrink
//! - **range**: largest less smallest torque of a cycle; N m
//! - **S-N (Wöhler) curve**: cycles to failure against the amplitude, half of the range
//! - **damage**: cycles over cycles to failure, summed over all ranges (Miner); failure at 1
//! - **torque amplification factor**: largest torque over the rated torque

mod class;
mod counts;
mod rainflow;
#[cfg(feature = "parameters")]
mod record;
mod woehler;

pub use class::{Classed, TorqueClasses};
pub use counts::Counts;
pub use rainflow::Rainflow;
#[cfg(feature = "parameters")]
pub use record::LifeRecord;
pub use woehler::WoehlerLine;
