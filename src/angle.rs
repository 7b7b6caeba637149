//! Angles on the tick: of a rotor or crank behind a gear, exact over any number of turns, and their cosine and sine.

mod rotor_angle;
mod sincos;

pub(crate) use rotor_angle::Passed;
pub use rotor_angle::{RotorAngle, RotorAngleConfig};
pub use sincos::Synchronous;
