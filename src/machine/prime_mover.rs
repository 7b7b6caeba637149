//! Prime movers: torque against speed, and against time during a start.

mod characteristic;
mod curve;
mod direct_current;
mod dynamic_factor;
mod induction;
mod starting;
mod starting_time;

pub use characteristic::Characteristic;
pub use curve::{Line, Parabola};
pub use direct_current::Series;
pub use induction::Induction;
pub use starting::StartingLaw;
