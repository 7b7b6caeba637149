//! Backlash take-up: a limit around another one that closes an open gap at the approach speed, then ramps the torque
//! up, and damps the shaft.
//!
//! A motor that accelerates freely through a gap meets the load at a relative speed delta omega, and the impact adds
//! `delta omega sqrt(k J_m J_l/(J_m + J_l))` to the shaft's torque [Huang 1987 part 2]; a torque applied at once adds
//! its share of the load's inertia a second time. So
//!
//! - while the gap is open, the governor's torque is limited to a small value, less a damping of the twist rate: the
//!   gap closes at the approach speed, torque over damping, at most;
//! - once it has closed, the limit rises from there by a step per tick, so that the governor's torque builds up over
//!   part of a period of the resonance; a shaft in contact for longer is not limited;
//! - in contact, `-k_d (omega_m - omega_l)` damps the shaft.
//!
//! The gap counts as open where the estimated shaft torque is exactly zero, as in
//! [`BacklashObserver`](crate::observer::BacklashObserver). The limit does not wind up the integral of its
//! [`SpeedGovernor`](super::SpeedGovernor).

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
    /// Rise of the limit per tick once the gap has closed [N m].
    pub step: N,
    /// The final limit [N m].
    pub max_torque: N,
    /// Active damping -k_d [N m s/rad], on the twist rate, in contact.
    pub damping: N::Coefficient,
    /// Constants of the other limit.
    pub limit: L,
}

/// Another limit, and an open gap is closed at the approach speed.
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
