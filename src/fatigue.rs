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
//!
//! ```
//! use driveline::fatigue::{Rainflow, TorqueClasses, WoehlerLine};
//! use driveline::fluctuation::Fluctuation;
//! use driveline::sample::Estimate;
//!
//! /// 64 classes between -640 and 640 N m.
//! const CLASSES: TorqueClasses<f32> = TorqueClasses::<f32>::new::<64>(640.0);
//! const STEEL: WoehlerLine = WoehlerLine { knee: 100.0, cycles: 2.0e6, slope: 5.0, below: 9.0 };
//!
//! let mut rainflow = Rainflow::<64, f32>::default(); // in a drive: its measurement of the fluctuation
//! for tick in 0..4000 {
//!     let torque = if tick / 20 % 2 == 0 { 310.0 } else { -290.0 }; // 100 cycles of 600 N m
//!     let estimate = Estimate { shaft_torque: torque, ..Estimate::default() };
//!     rainflow.measure(&CLASSES, 0, 0.0, &estimate); // in a drive: `drive.tick(..)`
//! }
//! let counts = rainflow.counts(&CLASSES); // between two ticks
//! let expected = 100.0 / (2.0e6 * (100.0_f64 / 300.0).powf(5.0));
//! assert!((counts.damage(&STEEL) / expected - 1.0).abs() < 0.01); // the residue has the last half cycle
//! ```

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
