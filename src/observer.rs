//! Estimate: what no sensor on the motor sees, from the motor's angle and torque alone.
//!
//! Every observer predicts the tick that has just ended from the torque applied during it, compares the
//! predicted motor angle with the measured one, and corrects each state by a constant gain times the difference, the *innovation*.
//! The gains are the steady state of a Kalman filter, found at compile time.
//!
//! | observer | states | for |
//! |---|---|---|
//! | [`RigidObserver`] | speed, load torque | shafts that are rigid to the controller |
//! | [`TwoMassObserver`] | mean speed, twist rate, twist, load torque | any stiffness, any tick rate |
//! | [`BacklashObserver`] | those of [`TwoMassObserver`], the twist through the gap | shafts with a gap that opens |
//! | [`SemiImplicitObserver`] | motor speed, load speed, shaft torque, load torque | soft shafts sampled fast |
//! | [`CrankObserver`] | speed, load torque, crank angle | rigid machines with a crank: an inertia that depends on the angle |
//!
//! [`GearedObserver`] puts any of them behind a gear with losses.
//!
//! # The angle
//! No observer stores the angle it estimates. Its [`AngleTracker`] stores the last measured angle as a `u32` of 2^32 per turn, and its
//! own distance from that as a number, the *residual*: the innovation is the wrapped difference of two measured
//! angles, plus the residual, less the predicted turn. Nothing grows with the revolutions, so nothing is lost after a
//! year of running, and an angle is never converted back to an integer.
//!
//! # Terms
//! *Base*: what a fixed-point number is a fraction of. *Coast*: a tick without a usable angle, by prediction
//! alone. *Innovation*: measured less predicted motor angle [2^-32 turn].

mod angle;
mod backlash;
mod cranked;
mod geared;
mod rigid;
mod semi_implicit;
mod two_mass;

pub use angle::{AngleTracker, Prediction};
pub use backlash::{BacklashConfig, BacklashObserver, Contact, Correction, FreeFlight, Gap};
pub use cranked::{CrankConfig, CrankObserver, TABLE_POINTS, TablePoint};
pub use geared::{GearedConfig, GearedObserver, Stiction};
pub use rigid::{RigidConfig, RigidObserver};
pub use semi_implicit::{SemiImplicitConfig, SemiImplicitObserver};
pub use two_mass::{TwoMassConfig, TwoMassObserver};

use crate::number::Number;
use crate::sample::Estimate;

/// An estimator of the drivetrain's state, advanced once a tick: predict, then correct or coast.
pub trait Observer<N: Number>: Sized {
    /// Its constants, shared and immutable.
    type Config;
    /// States of its [`Prediction`].
    type States;

    /// A machine that turns steadily at `speed` and is at `angle`, its shaft carrying `torque` against the load.
    fn steady(config: &Self::Config, angle: u32, torque: N, speed: N) -> Self;

    /// A machine that stands still at `angle`, its shaft carrying `torque`, as after a brake has been closed on it.
    fn at_rest(config: &Self::Config, angle: u32, torque: N) -> Self {
        Self::steady(config, angle, torque, N::ZERO)
    }

    /// Starts anew: what [`steady`](Self::steady) says, but for what the observer knows beyond its states.
    #[inline(always)]
    fn restart(&mut self, config: &Self::Config, angle: u32, torque: N, speed: N) {
        *self = Self::steady(config, angle, torque, speed);
    }

    /// The speed at which the motor turns by `turned` [2^-32 turn] in a tick.
    fn speed_of_turn(config: &Self::Config, turned: N) -> N;

    /// Takes the angle as it comes, whatever was predicted.
    fn resync(&mut self, angle: u32);

    /// Predicts the tick that has just ended, in which `torque` was applied and at the end of which `angle` was measured.
    fn predict(&self, config: &Self::Config, angle: u32, torque: N) -> Prediction<N, Self::States>;

    /// Takes the prediction, corrected by its innovation, for the state.
    fn correct(&mut self, config: &Self::Config, predicted: Prediction<N, Self::States>, angle: u32);

    /// Takes the prediction, which was made for `angle`, for the state as it is: the angle cannot be used.
    fn coast(&mut self, predicted: Prediction<N, Self::States>, angle: u32);

    /// What is known now.
    fn estimate(&self, config: &Self::Config) -> Estimate<N>;

    /// The angle that was last believed, 2^32 per turn.
    fn angle(&self) -> u32;

    /// [`Number::beyond_base`] of the motor's speed, the twist or shaft torque, and the load torque.
    fn beyond_base(&self) -> u32;

    /// One tick with an angle that is known to be good.
    #[inline(always)]
    fn step(&mut self, config: &Self::Config, angle: u32, torque: N) {
        let predicted = self.predict(config, angle, torque);
        self.correct(config, predicted, angle);
    }
}
