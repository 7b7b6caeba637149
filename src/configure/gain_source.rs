//! Source of a governor's gains.

use super::Machine;
use crate::design::{GovernorDesign, LoadFeedForward, SpeedLoopDesign};

/// Source of the gains of [`SpeedGovernor`](crate::governor::SpeedGovernor).
///
/// ```
#[doc = include_str!("../generator_set.txt")]
/// // by the symmetrical optimum with a factor of 2.5: k_p = J/(2.5 T_s), T_s the delays of actuator and tick
/// const DESIGN: GovernorDesign = Set::TWO_MASS.governor(Set::RATE, Set::ACTUATOR, 2.5, FED);
/// assert_eq!(Set::GAINS, GainSource::Governor(DESIGN));
/// assert!((DESIGN.proportional * 2.5 * DESIGN.equivalent_delay / (4.4 + 8.0) - 1.0).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum GainSource {
    /// The speed loop of a torque-controlled drive.
    SpeedLoop(SpeedLoopDesign),
    /// The governor of a slow actuator, with its feed-forward.
    Governor(GovernorDesign),
}

impl GainSource {
    /// Those of [`TwoMass::governor`](crate::machine::TwoMass::governor) for the machine `M`, with its two masses, its
    /// rate and its actuator. `optimum_factor` is a of the symmetrical optimum, from 2 (fast) to 4 (well damped).
    ///
    /// # Panics
    /// At compile time in a constant, for a value out of range or an unstable loop.
    #[must_use]
    pub const fn governor<M: Machine>(optimum_factor: f64, forward: LoadFeedForward) -> Self {
        GainSource::Governor(M::TWO_MASS.governor(M::RATE, M::ACTUATOR, optimum_factor, forward))
    }

    /// The proportional gain (N m s/rad).
    pub(super) const fn proportional(&self) -> f64 {
        match self {
            GainSource::SpeedLoop(design) => design.proportional,
            GainSource::Governor(design) => design.proportional,
        }
    }

    /// The integral gain in a tick, k_i T (N m s/rad).
    pub(super) const fn integral(&self) -> f64 {
        match self {
            GainSource::SpeedLoop(design) => design.integral * design.period,
            GainSource::Governor(design) => design.integral * design.period,
        }
    }

    pub(super) const fn design(&self) -> &GovernorDesign {
        match self {
            GainSource::Governor(design) => design,
            GainSource::SpeedLoop(_) => panic!(
                "feed-forward and acceleration feedback need a governor's design: let GAINS be GainSource::Governor"
            ),
        }
    }
}
