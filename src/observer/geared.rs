//! A gear's loss, taken off the torque before an observer sees it.
//!
//! The driving side supplies the loss [Wang 1989 §1-3, Huang 1987 ch. 1]: while the motor drives it feels T/eta for a shaft torque T, while the
//! load drives only eta T. The difference is a friction of about lambda T, with lambda half of (1/eta - 1) + (1 - eta), that opposes the motion;
//! at a standstill it takes any value up to that, and holds the gear. What is left of the motor's torque is
//!
//! ```text
//! tau = tau_m - friction,   friction = tau_m - T + c omega_m, held within +-lambda |T|
//! ```
//!
//! in motion the limit, at a standstill just what balances the motor against the shaft, with c omega_m to bring the estimate to rest there. T
//! is the torque behind the gear, the one that shaft, rope and load feel. Without this a loss of 6 % is taken for shaft torque,
//! and its reversal for a jerk of the load.

use super::Observer;
use crate::number::Number;
use crate::sample::Estimate;

/// Constants of [`Geared`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct GearedConfig<N: Number, C> {
    /// Constants of the observer behind the gear.
    pub observer: C,
    /// Friction per shaft torque in motion, lambda.
    pub friction: N::Coefficient,
    /// How firmly a standing gear is held, c [N m s/rad].
    pub stiction: N::Coefficient,
}

/// An observer behind a gear with losses.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Geared<O> {
    observer: O,
}

impl<N: Number, O: Observer<N>> Observer<N> for Geared<O> {
    type Config = GearedConfig<N, O::Config>;
    type Prediction = O::Prediction;

    fn steady(config: &Self::Config, angle: u32, torque: N, speed: N) -> Self {
        Geared { observer: O::steady(&config.observer, angle, torque, speed) }
    }

    fn speed_of_turn(config: &Self::Config, turned: N) -> N {
        O::speed_of_turn(&config.observer, turned)
    }

    fn synchronise(&mut self, angle: u32, residual: N) {
        self.observer.synchronise(angle, residual);
    }

    #[inline(always)]
    fn predict(&self, config: &Self::Config, angle: u32, torque: N) -> O::Prediction {
        let now = self.observer.estimate(&config.observer);
        let mut carry = N::CARRY;
        let limit = N::product(&mut carry, config.friction, now.shaft_torque).magnitude();
        let friction = torque
            .minus(now.shaft_torque)
            .accumulate(&mut carry, config.stiction, now.motor_speed.gain_operand())
            .limited(limit);
        let torque = torque.minus(friction);
        self.observer.predict(&config.observer, angle, torque)
    }

    #[inline(always)]
    fn correct(&mut self, config: &Self::Config, predicted: O::Prediction, angle: u32) {
        self.observer.correct(&config.observer, predicted, angle);
    }

    #[inline(always)]
    fn coast(&mut self, predicted: O::Prediction) {
        self.observer.coast(predicted);
    }

    #[inline(always)]
    fn estimate(&self, config: &Self::Config) -> Estimate<N> {
        self.observer.estimate(&config.observer)
    }

    #[inline(always)]
    fn angle(&self) -> u32 {
        self.observer.angle()
    }

    #[inline(always)]
    fn is_beyond_base(&self) -> bool {
        self.observer.is_beyond_base()
    }
}
