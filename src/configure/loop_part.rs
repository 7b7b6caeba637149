//! The parts of a drive in its speed loop, and the test of its stability.

use super::{Configure, GainSource, Machine, Refusal};
use crate::design::{
    Actuator, Averaging, GovernorDesign, LoopGears, LoopObserver, RigidDesign, SpeedLoopDesign, TwoMassDesign,
};
use crate::number::Number;

/// A part in the speed loop, by what it brings to the loop's response.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LoopPart {
    /// An observer of two masses.
    pub two_mass: Option<TwoMassDesign>,
    /// An observer of one mass.
    pub rigid: Option<RigidDesign>,
    /// Gains of a governor.
    pub gains: Option<GainSource>,
    /// A torque against the twist rate (N m s/rad), added to the governor's.
    pub damping: f64,
    /// Share of the load torque that is fed forward.
    pub forward: f64,
    /// Torque against the acceleration, per torque that accelerates the load.
    pub acceleration: f64,
    /// Average of the speed.
    pub averaging: Averaging,
    /// Friction per torque before the shaft that an observer deducts.
    pub friction: f64,
    /// Whether an observer deducts the losses behind the shaft.
    pub losses_behind: bool,
}

impl LoopPart {
    /// It changes nothing in the loop.
    pub const NONE: Self = Self {
        two_mass: None,
        rigid: None,
        gains: None,
        damping: 0.0,
        forward: 0.0,
        acceleration: 0.0,
        averaging: Averaging::None,
        friction: 0.0,
        losses_behind: false,
    };

    /// Two parts of a governor together.
    pub(super) const fn and(&self, other: &Self) -> Self {
        Self {
            two_mass: if self.two_mass.is_some() { self.two_mass } else { other.two_mass },
            rigid: if self.rigid.is_some() { self.rigid } else { other.rigid },
            gains: if self.gains.is_some() { self.gains } else { other.gains },
            damping: self.damping + other.damping,
            forward: self.forward + other.forward,
            acceleration: self.acceleration + other.acceleration,
            averaging: match self.averaging {
                Averaging::None => other.averaging,
                averaging => averaging,
            },
            friction: self.friction + other.friction,
            losses_behind: self.losses_behind || other.losses_behind,
        }
    }

    /// Why the speed loop of observer and governor is refused: it lacks margin, or is unstable within the machine's
    /// tolerances.
    const fn refused<M: Machine>(&self, governor: &Self) -> Option<&'static str> {
        let tested = match &governor.gains {
            Some(GainSource::SpeedLoop(design)) => return self.speed_loop_refused::<M>(design, governor),
            Some(GainSource::Governor(_)) if governor.damping != 0.0 => {
                return Some(
                    "a damping of the twist rate needs the gains of a speed loop: let GAINS be GainSource::SpeedLoop",
                );
            }
            Some(GainSource::Governor(design)) => {
                let LoopPart { forward: share, acceleration, averaging, .. } = *governor;
                let design = GovernorDesign { share, acceleration, ..*design };
                // a lag of the estimates counts where there is no observer
                let tested = design.try_robust(&M::TWO_MASS, self.observer(), averaging, &M::ROBUSTNESS);
                match (tested, self.observer()) {
                    (Ok(()), Some(observer)) => self.gears::<M>().try_robust_governor(
                        &M::TWO_MASS,
                        observer,
                        &design,
                        averaging,
                        &M::ROBUSTNESS,
                    ),
                    (tested, _) => tested,
                }
            }
            None => Ok(()),
        };
        match tested {
            Ok(()) => None,
            Err(error) => Some(error.message()),
        }
    }

    const fn gears<M: Machine>(&self) -> LoopGears {
        LoopGears { losses: M::CHAIN.losses(), friction: self.friction, behind: self.losses_behind }
    }

    const fn observer(&self) -> Option<LoopObserver<'_>> {
        match (&self.two_mass, &self.rigid) {
            (Some(design), _) => Some(LoopObserver::TwoMass(design)),
            (None, Some(design)) => Some(LoopObserver::Rigid(design)),
            (None, None) => None,
        }
    }

    const fn speed_loop_refused<M: Machine>(&self, design: &SpeedLoopDesign, governor: &Self) -> Option<&'static str> {
        let Some(observer) = self.observer() else { return None };
        let late = match governor.averaging {
            Averaging::None => 0.0,
            Averaging::Ticks(_) if governor.damping != 0.0 => {
                return Some(
                    "a damping takes the twist rate, of which an average of the motor's speed leaves no part: give the \
                    governor the damping or the average, not both",
                );
            }
            // its phase; its gain is below one
            Averaging::Ticks(ticks) => 0.5 * (ticks as f64 - 1.0) * M::PERIOD,
            Averaging::Cycle(_) => {
                return Some(
                    "an average of the speed over a cycle needs a governor's design: let GAINS be GainSource::Governor",
                );
            }
        };
        let speed_loop = SpeedLoopDesign { damping: design.damping + governor.damping, ..*design };
        let Actuator { delay, lag } = M::ACTUATOR;
        let actuator = Actuator { delay: delay + late, lag };
        let (machine, robustness) = (&M::TWO_MASS, &M::ROBUSTNESS);
        let tested = match machine.try_robust(observer, &speed_loop, actuator, &M::TOLERANCE, robustness) {
            Ok(()) => self.gears::<M>().try_robust(machine, observer, &speed_loop, actuator, robustness),
            tested => tested,
        };
        match tested {
            Ok(()) => None,
            Err(error) => Some(error.message()),
        }
    }
}

/// Why the speed loop of an observer and a governor is refused.
pub(super) const fn refused<M: Machine, N: Number, O: Configure<M, N>, G: Configure<M, N>>() -> Option<Refusal> {
    match O::LOOP.refused::<M>(&G::LOOP) {
        Some(sentence) => Some(Refusal::new(sentence)),
        None => None,
    }
}
