//! Piston engines: cylinders about a crankshaft, their free forces and moments, and their torque by orders.

mod cylinder;
mod indicator;
mod shaking;
mod torque;

pub use cylinder::{Cylinder, WorkingCycle, phasor_sum};
pub use indicator::Indicator;
pub use shaking::{Shaking, free_forces, free_moments};
pub use torque::Harmonic;
