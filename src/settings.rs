//! Settings: from a design to the constants that the tick loads, in floats or fixed point.
//!
//! A design is in `f64` and SI units. Floats take it as it is, rounded; [`Fixed`](crate::number::Fixed) is per unit of
//! [`Bases`], and its coefficients have formats of their own. Everything is `const fn`, so a firmware holds nothing but
//! the result; the same functions run on a machine that is commissioned in the field.

mod actuator_monitor;
mod backlash;
mod backlash_takeup;
mod bases;
mod constants;
mod convert;
mod error;
mod fluctuation;
mod format;
mod geared;
mod governor_parts;
mod governor_shapes;
mod limits;
mod load_sharing;
mod mechanism;
mod observer;
mod phasors;
mod settled;
mod speed_loop;
mod supervision;
mod to;
mod wheel;

pub use actuator_monitor::ActuatorMonitorSettings;
pub use bases::Bases;
pub use error::Error;
pub use fluctuation::Cycle;
pub use geared::{Gear, LoadGear};
pub use governor_parts::SequencerSettings;
pub use limits::Screening;
pub use load_sharing::LoadSharingSettings;
pub use phasors::{PhasorError, PhasorSettings};
pub use speed_loop::SpeedLoopSettings;
pub use wheel::{Teeth, ToothClock};

pub(crate) use format::Format;
