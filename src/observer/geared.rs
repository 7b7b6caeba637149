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
//!
//! While the gear is held, the motor's angle says nothing of the load: what little it moves is the motor on its own shaft. The innovation is then
//! left out, up to the play that such a shaft has.

use super::{Observer, Predicted};
use crate::number::Number;
use crate::sample::Estimate;

/// Constants of [`GearedObserver`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct GearedConfig<N: Number, C> {
    /// Constants of the observer behind the gear.
    pub observer: C,
    /// Friction per shaft torque in motion, lambda.
    pub friction: N::Coefficient,
    /// How firmly a standing gear is held, c [N m s/rad].
    pub stiction_gain: N::StictionGain,
    /// Largest innovation that a held gear leaves out [2^-32 turn].
    pub deadband: N,
}

/// An observer behind a gear with losses.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct GearedObserver<O> {
    observer: O,
}

/// The prediction of the observer behind the gear, and whether the gear was held.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct GearedPrediction<P> {
    observer: P,
    held: bool,
}

impl<N, P: Predicted<N>> Predicted<N> for GearedPrediction<P> {
    #[inline(always)]
    fn innovation(&self) -> N {
        self.observer.innovation()
    }

    #[inline(always)]
    fn turn(&self) -> N {
        self.observer.turn()
    }
}

impl<N: Number, O: Observer<N>> Observer<N> for GearedObserver<O> {
    type Config = GearedConfig<N, O::Config>;
    type Prediction = GearedPrediction<O::Prediction>;

    fn restart(&mut self, config: &Self::Config, angle: u32, torque: N, speed: N) {
        self.observer.restart(&config.observer, angle, torque, speed);
    }

    fn steady(config: &Self::Config, angle: u32, torque: N, speed: N) -> Self {
        GearedObserver { observer: O::steady(&config.observer, angle, torque, speed) }
    }

    fn speed_of_turn(config: &Self::Config, turned: N) -> N {
        O::speed_of_turn(&config.observer, turned)
    }

    fn resync(&mut self, angle: u32) {
        self.observer.resync(angle);
    }

    #[inline(always)]
    fn predict(&self, config: &Self::Config, angle: u32, torque: N) -> Self::Prediction {
        let now = self.observer.estimate(&config.observer);
        let limit = now.shaft_torque.times(config.friction).magnitude();
        let holding = torque.minus(now.shaft_torque).plus(now.motor_speed.braked(config.stiction_gain));
        let friction = holding.limited(limit);
        GearedPrediction {
            observer: self.observer.predict(&config.observer, angle, torque.minus(friction)),
            held: friction == holding,
        }
    }

    #[inline(always)]
    fn correct(&mut self, config: &Self::Config, predicted: Self::Prediction, angle: u32) {
        if predicted.held && !predicted.innovation().exceeds(config.deadband) {
            // Moving is the rule: one instruction less on the M3.
            core::hint::cold_path();
            self.observer.coast(predicted.observer, angle);
        } else {
            self.observer.correct(&config.observer, predicted.observer, angle);
        }
    }

    #[inline(always)]
    fn coast(&mut self, predicted: Self::Prediction, angle: u32) {
        self.observer.coast(predicted.observer, angle);
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
    fn beyond_base(&self) -> u32 {
        self.observer.beyond_base()
    }
}
