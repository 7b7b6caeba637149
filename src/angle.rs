//! Angles on the tick: of a rotor or crank behind a gear, exact over any number of turns, or with one pulse a turn, and
//! their cosine and sine.

mod once_per_turn;
mod rotor_angle;
mod sincos;

pub use once_per_turn::OncePerTurn;
pub use rotor_angle::RotorAngleConfig;
pub(crate) use rotor_angle::{Passed, RotorAngle};
pub use sincos::Synchronous;
