//! The parts of a drive in its speed loop, and the test of its stability.

use super::Machine;
use crate::design::{LoopObserver, RigidDesign, SpeedLoopDesign, TwoMassDesign};

/// A part in the speed loop.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
// A value of a constant evaluation, never stored.
#[allow(clippy::large_enum_variant)]
pub enum LoopPart {
    /// It changes nothing in the loop.
    None,
    /// It changes the loop in a way that the test does not model.
    Unknown,
    /// An observer of two masses.
    TwoMass(TwoMassDesign),
    /// An observer of one mass.
    Rigid(RigidDesign),
    /// A governor.
    SpeedLoop(SpeedLoopDesign),
    /// A torque against the twist rate (N m s/rad), added to the governor's.
    Damping(f64),
}

impl LoopPart {
    /// Two parts of a governor together.
    pub(super) const fn and(&self, other: &Self) -> Self {
        match (self, other) {
            (Self::None, part) | (part, Self::None) => *part,
            (Self::Damping(one), Self::Damping(two)) => Self::Damping(*one + *two),
            (Self::SpeedLoop(design), Self::Damping(more)) | (Self::Damping(more), Self::SpeedLoop(design)) => {
                Self::SpeedLoop(SpeedLoopDesign { damping: design.damping + *more, ..*design })
            }
            _ => Self::Unknown,
        }
    }

    /// Stops the compilation where the speed loop of observer and governor lacks margin, or is unstable within the
    /// machine's tolerances.
    pub(super) const fn test<M: Machine>(&self, governor: &Self) {
        let Self::SpeedLoop(speed_loop) = governor else { return };
        let observer = match self {
            Self::TwoMass(design) => LoopObserver::TwoMass(design),
            Self::Rigid(design) => LoopObserver::Rigid(design),
            _ => return,
        };
        M::TWO_MASS.robust(observer, speed_loop, M::ACTUATOR, &M::TOLERANCE, &M::ROBUSTNESS);
    }
}
