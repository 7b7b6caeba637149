//! Angles on the tick: of a rotor or crank behind a gear, exact over any number of turns, or with one pulse a turn, and
//! their cosine and sine.

mod once_per_turn;
mod rotor_angle;
mod sincos;

pub use once_per_turn::OncePerTurn;
pub(crate) use rotor_angle::Passed;
pub use rotor_angle::{RotorAngle, RotorAngleConfig};
pub use sincos::Synchronous;
