//! Estimate: what no sensor on the motor sees, from the motor's angle and torque alone.
//!
//! Every observer predicts the tick that has just ended from the torque applied during it, compares the
//! predicted motor angle with the measured one, and corrects each state by a constant gain times the difference, the *innovation*.
//! The gains are the steady state of a Kalman filter, found at compile time.
//!
//! | observer | states | for |
//! |---|---|---|
//! | [`Rigid`] | speed, load torque | shafts that are rigid to the controller |
//! | [`TwoMass`] | mean speed, twist rate, twist, load torque | any stiffness, any tick rate |
//! | [`SemiImplicit`] | motor speed, load speed, shaft torque, load torque | soft shafts sampled fast |
//!
//! # The angle
//! No observer stores the angle it estimates. It stores the last measured angle as a `u32` of 2^32 per turn, and its
//! own distance from that as a number, the *residual*: the innovation is the wrapped difference of two measured
//! angles, plus the residual, less the predicted turn. Nothing grows with the revolutions, so nothing is lost after a
//! year of running, and an angle is never converted back to an integer.
//!
//! # Terms
//! *Base*: what a fixed-point number is a fraction of. *Coast*: a tick without a usable angle, by prediction
//! alone. *Innovation*: measured less predicted motor angle [2^-32 turn].

mod rigid;
mod semi_implicit;
mod two_mass;

pub use rigid::{Rigid, RigidConfig};
pub use semi_implicit::{SemiImplicit, SemiImplicitConfig};
pub use two_mass::{TwoMass, TwoMassConfig};

use crate::number::Number;
use crate::sample::Estimate;

/// An estimator of the drivetrain's state, advanced once a tick.
pub trait Observer<N: Number>: Default {
    /// Its constants, shared and immutable.
    type Config;

    /// Takes the angle as it comes, believing neither speed nor torque: the first tick, and the first after the angle was lost.
    fn synchronise(&mut self, angle: u32);

    /// Advances over the tick that has just ended, in which `torque` was applied, and corrects by `angle`. Returns whether
    /// the angle was believed; one that was not has been left out, as in [`Observer::coast`].
    fn update(&mut self, config: &Self::Config, angle: u32, torque: N) -> bool;

    /// Advances by prediction alone.
    fn coast(&mut self, config: &Self::Config, torque: N);

    /// What is known now.
    fn estimate(&self, config: &Self::Config) -> Estimate<N>;

    /// The angle that was last believed, 2^32 per turn.
    fn angle(&self) -> u32;

    /// Whether a state is held at the end of its fixed-point range.
    fn is_saturated(&self) -> bool;
}
