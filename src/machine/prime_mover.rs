//! Prime movers: torque against speed, and against time during a start.

mod characteristic;
mod combustion;
mod curve;
mod direct_current;
mod dynamic_factor;
mod induction;
mod resistor_start;
mod soft_start;
mod starting;
mod starting_time;

pub use characteristic::Characteristic;
pub use combustion::{Combustion, CombustionType};
pub use curve::{Line, Parabola};
pub use direct_current::{Series, Shunt};
pub use induction::Induction;
pub use resistor_start::ResistorStart;
pub use soft_start::SoftStart;
pub use starting::{StartCondition, StartingLaw};
