//! From a design to the constants that the tick path loads: the one place that knows both.
//!
//! A design is in `f64` and SI units. Floats take it as it is, rounded; [`Fixed`](crate::number::Fixed) is per unit of [`Bases`], and its
//! coefficients have formats of their own. Everything is `const fn`, so a firmware holds nothing but the result; the same functions run
//! on a machine that is commissioned in the field.

mod actuator_watch;
mod backlash;
mod bases;
mod convert;
mod cranked;
mod fluctuation;
mod format;
mod geared;
mod governor;
mod governor_parts;
mod governor_shapes;
mod limits;
mod observer;
mod phasors;
mod settled;
mod slack;

pub use actuator_watch::ActuatorWatchSettings;
pub use bases::Bases;
pub use convert::Error;
pub use fluctuation::{Cycle, Wheel};
pub use geared::Gear;
pub use governor::SpeedLoopSettings;
pub use governor_parts::ModesSettings;
pub use limits::Screening;
pub use phasors::{Measured, MeasuredError};

pub(crate) use format::Format;
