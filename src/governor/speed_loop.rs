//! A speed loop: proportional and integral, active damping, limits, anti-windup.
//!
//! ```text
//! tau = k_p (omega* - omega_m) + I - k_d (omega_m - omega_l),   I' = I + k_i (omega* - omega_m)
//! ```
//!
//! limited to the drive's torque. Anti-windup is by back-calculation with the integral's own time constant. The
//! setpoint moves by at most the ramp's step a tick. Filters of the ramped setpoint and of the twist rate are optional:
//! [`LoopFilter`].

use super::{Governor, LoopFilter};
use crate::number::Number;
use crate::sample::Estimate;

/// Constants of [`SpeedLoop`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SpeedLoopConfig<N: Number, F = ()> {
    /// Proportional gain k_p (N m s/rad).
    pub proportional: N::Coefficient,
    /// Integral gain per tick, k_i T (N m s/rad).
    pub integral: N::Coefficient,
    /// Active damping -k_d (N m s/rad), on the twist rate.
    pub damping: N::Coefficient,
    /// Anti-windup gain: share of the limited torque fed back to the integral in a tick, k_i T/k_p.
    pub anti_windup: N::Coefficient,
    /// Largest torque, in either direction (N m).
    pub torque_limit: N,
    /// Largest change of the setpoint in a tick (rad/s).
    pub ramp: N,
    /// Constants of the filters.
    pub filter: F,
}

impl<N: Number> SpeedLoopConfig<N> {
    /// The same with the constants of filters.
    #[must_use]
    pub const fn with_filter<F: Copy>(self, filter: F) -> SpeedLoopConfig<N, F> {
        let Self { proportional, integral, damping, anti_windup, torque_limit, ramp, filter: () } = self;
        SpeedLoopConfig { proportional, integral, damping, anti_windup, torque_limit, ramp, filter }
    }
}

/// State of the speed loop.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SpeedLoop<N, F = ()> {
    integral: N,
    ramped: N,
    setpoint: N,
    filter: F,
}

impl<N: Copy, F> SpeedLoop<N, F> {
    /// The ramped setpoint (rad/s).
    pub fn ramped_setpoint(&self) -> N {
        self.ramped
    }
}

impl<N: Number, F: LoopFilter<N>> Governor<N> for SpeedLoop<N, F> {
    type Config = SpeedLoopConfig<N, F::Config>;

    const COMMANDS: bool = true;

    #[inline(always)]
    fn set_setpoint(&mut self, setpoint: N) {
        self.setpoint = setpoint;
    }

    #[inline(always)]
    fn command(&mut self, config: &Self::Config, estimate: &Estimate<N>) -> N {
        let mut carry = N::CARRY;
        let step = (self.setpoint - self.ramped).limited(config.ramp);
        self.ramped = self.ramped + step;
        let setpoint = self.filter.setpoint(&mut carry, config.anti_windup, step, self.ramped);
        let error = (setpoint - estimate.motor_speed).gain_operand();
        let twist_rate = estimate.motor_speed - estimate.load_speed;
        let twist_rate = self.filter.twist_rate(&mut carry, &config.filter, twist_rate).gain_operand();
        let integral = self.integral.accumulate(&mut carry, [config.integral], [error]);
        let prompt = N::truncated([config.proportional, config.damping], [error, twist_rate]);
        let wanted = integral + prompt;
        let torque = wanted.limited(config.torque_limit);
        self.integral = integral.accumulate(&mut carry, [config.anti_windup], [torque - wanted]).saturated();
        torque
    }

    /// The integral takes over the difference of the torques.
    fn switch(&mut self, from: &Self::Config, to: &Self::Config, estimate: &Estimate<N>) {
        let error = (self.filter.filtered_setpoint(self.ramped) - estimate.motor_speed).gain_operand();
        let twist_rate = self.filter.filtered_twist_rate(estimate.motor_speed - estimate.load_speed).gain_operand();
        let prompt = |c: &Self::Config| N::truncated([c.proportional, c.damping], [error, twist_rate]);
        self.integral = (self.integral + (prompt(from) - prompt(to))).saturated();
    }

    fn start(&mut self, config: &Self::Config, estimate: &Estimate<N>, torque: N) {
        self.ramped = estimate.motor_speed;
        self.setpoint = N::ZERO;
        self.integral = torque.limited(config.torque_limit);
        self.filter = F::default();
    }
}
