//! Slack taken up gently: a limit round another one that closes an open gap at a creep, lets the torque rise slowly
//! after it, and damps the shaft.
//!
//! A motor that accelerates freely through a gap meets the load at a speed delta omega, and the impact adds
//! `delta omega sqrt(k J_m J_l/(J_m + J_l))` to the shaft's torque [Huang 1987 part 2]; a torque that is there at once
//! adds its share of the load's inertia a second time. So
//!
//! - while the gap is open, the governor's torque is held within a small one, less a damping of the twist rate: the gap closes
//!   at a creep, torque over damping, at the most;
//! - once it has closed, the largest torque rises from there by a step a tick, so that what the governor wants comes
//!   over a part of a period of the resonance and not at once; a shaft that has been in contact for longer is not held
//!   back;
//! - in contact, `-k_d (omega_m - omega_l)` damps the shaft.
//!
//! The gap counts as open where the estimated shaft torque is exactly zero, which is how
//! [`BacklashObserver`](crate::observer::BacklashObserver) says so. What is cut off does not wind up the integral of the
//! [`SpeedGovernor`](super::SpeedGovernor) that this is a part of.

use super::Limit;
use crate::number::Number;
use crate::sample::Estimate;

/// Constants of [`BacklashTakeUp`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BacklashTakeUpConfig<N: Number, L> {
    /// Largest torque while the gap is open [N m].
    pub torque: N,
    /// Damping of the twist rate while the gap is open [N m s/rad], negative.
    pub braking: N::Coefficient,
    /// By how much the largest torque rises in a tick once the gap has closed [N m].
    pub step: N,
    /// What it rises to [N m].
    pub max_torque: N,
    /// Active damping -k_d [N m s/rad], on the twist rate, in contact.
    pub damping: N::Coefficient,
    /// Constants of the other limit.
    pub limit: L,
}

/// Another limit, and an open gap is closed at a creep.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BacklashTakeUp<N, L> {
    reach: N,
    limit: L,
}

impl<N: Number, L: Limit<N>> Limit<N> for BacklashTakeUp<N, L> {
    type Config = BacklashTakeUpConfig<N, L::Config>;

    #[inline(always)]
    fn limit(&mut self, config: &Self::Config, estimate: &Estimate<N>, wanted: N) -> N {
        let twist_rate = (estimate.motor_speed - estimate.load_speed).gain_operand();
        let allowed = if estimate.shaft_torque == N::ZERO {
            self.reach = config.torque;
            (wanted.limited(config.torque) + twist_rate.times(config.braking)).limited(config.torque)
        } else {
            self.reach = (self.reach + config.step).limited(config.max_torque);
            (wanted.limited(self.reach) + twist_rate.times(config.damping)).saturated()
        };
        self.limit.limit(&config.limit, estimate, allowed)
    }

    #[inline(always)]
    fn start(&mut self, torque: N) {
        self.reach = torque.magnitude();
        self.limit.start(torque);
    }
}
