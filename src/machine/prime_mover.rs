//! Prime movers: torque against speed, and against time during a start.
//!
//! | prime mover | shape | source |
//! |---|---|---|
//! | [`Line`] | straight line through two points; a shunt motor, any motor near its rated point | [Wang 1989 (1-6)] |
//! | [`Parabola`] | through three points of a measured curve | [Wang 1989 (1-7)] |
//! | [`Induction`] | with breakdown torque; with rotor resistance for cranes | [Wang 1989 (1-8)], Kloss 1909 |
//! | [`Combustion`] | full-load curve, with a governor above rated speed | Leiderman; Jazar, Vehicle Dynamics, ch. 4 |
//! | [`Shunt`], [`Series`] | direct-current motors from voltage, resistance and flux | derived; shapes: Wang 1989 §1-2 |
//! | [`Characteristic`] | any of them, with its slope | |
//! | [`ResistorStart`] | start of a slip-ring motor by resistors in steps | derived |
//! | [`SoftStart`] | start by reduced voltage under a torque limit | derived |
//! | [`StartingLaw`] | `tau`, `tau (1 - t/T)`, `tau (1 - t^2/T^2)` | [Huang 1987 §2.2] |
//!
//! Torques are in N m, speeds in rad/s, at the motor's shaft. The stiffness of a characteristic is `|d tau/d omega|`
//! (N m s/rad): it damps the machine where the torque falls with the speed. The overload capacity is the largest
//! torque over the rated one.

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
