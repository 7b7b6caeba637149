//! The prelude: the imports of a first drive, by one `use`.

pub use crate::adaptive::{Adaptive, Known, Learners, LoadAndRope};
pub use crate::configure::{HasLoadAndRope, Machine, Rating};
pub use crate::design::{Disturbance, Encoder};
pub use crate::drive::{Actuated, ConfigOf, Drive};
pub use crate::governor::SpeedLoop;
pub use crate::machine::{
    Chain, Damping, Diameter, Efficiency, Falls, Inertia, Length, LinearDamping, Mass, Ratio, Speed, Stiffness, Torque,
};
pub use crate::number::Fixed;
pub use crate::observer::TwoMassObserver;
pub use crate::sample::Sample;
