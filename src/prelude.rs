//! The prelude: the imports of a drive, by one `use`.

pub use crate::adaptive::{Adaptive, HoistDrive, Known, Learners, LoadAndRope};
pub use crate::configure::{GainSource, HasActuator, HasLoadAndRope, HasTorqueCurve, HasVibration, Machine, Rating};
pub use crate::design::{Actuator, Disturbance, Encoder, LoadFeedForward, SpeedLoopTuning};
pub use crate::drive::{Actuated, ConfigOf, Drive};
pub use crate::fluctuation::Interleaved;
pub use crate::governor::{EngineGovernor, RunRequest, RunState, SpeedLoop, TakeUpGovernor};
pub use crate::machine::{
    Chain, Damping, Diameter, Efficiency, Falls, Gap, Inertia, Length, LinearDamping, Mass, Match, Ratio, Speed,
    Stiffness, Torque, TwoMass,
};
pub use crate::number::Fixed;
pub use crate::observer::{BacklashObserver, SemiImplicitObserver, TwoMassObserver};
pub use crate::sample::Sample;
