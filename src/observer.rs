//! State observers: shaft torque, load speed and load torque from motor angle and torque.
//!
//! Every observer predicts the tick that has just ended from the torque applied during it. It compares the predicted
//! motor angle with the measured one and corrects each state by a constant gain times the difference, the *innovation*.
//! The gains are the steady state of a Kalman filter, found at compile time.
//!
//! | observer | states | for |
//! |---|---|---|
//! | [`RigidObserver`] | speed, load torque | shafts that are rigid at the controller's bandwidth |
//! | [`TwoMassObserver`] | mean speed, twist rate, twist, load torque | any stiffness, any tick rate |
//! | [`BacklashObserver`] | those of [`TwoMassObserver`], the twist through the gap | shafts with backlash |
//! | [`SemiImplicitObserver`] | motor speed, load speed, shaft torque, load torque | soft shafts sampled fast |
//! | [`MechanismObserver`] | speed, load torque, crank angle | rigid machines with a crank, linkage or cam: an inertia that depends on the angle |
//!
//! [`GearedObserver`] puts any of them behind a gear with losses, [`LoadGearObserver`] in front of one.
//!
//! # The angle
//! No observer stores the angle it estimates. Its [`AngleTracker`] stores the last measured angle as a `u32` of 2^32
//! per turn, and its own distance from that as a number, the *residual*: the innovation is the wrapped difference of
//! two measured angles, plus the residual, less the predicted turn. Nothing grows with the revolutions, so resolution
//! stays the same after a year of running, and no angle is converted back to an integer.
//!
//! # Terms
//! *Base*: unit of a fixed-point number. *Coast*: a tick without a usable angle, by prediction
//! alone. *Innovation*: measured less predicted motor angle (2^-32 turn).

/// What an observer around another hands on unchanged.
macro_rules! passed_on {
    () => {
        fn switch(&mut self, from: &Self::Config, to: &Self::Config) {
            self.observer.switch(&from.observer, &to.observer);
        }

        fn speed_of_turn(config: &Self::Config, turned: N) -> N {
            O::speed_of_turn(&config.observer, turned)
        }

        fn resync(&mut self, angle: u32) {
            self.observer.resync(angle);
        }

        #[inline(always)]
        fn known_torque(&self, config: &Self::Config) -> N {
            self.observer.known_torque(&config.observer)
        }

        #[inline(always)]
        fn angle(&self) -> u32 {
            self.observer.angle()
        }

        #[inline(always)]
        fn beyond_base(&self) -> u32 {
            self.observer.beyond_base()
        }
    };
}

/// What every observer does with its tracker of the angle.
macro_rules! tracked {
    () => {
        fn speed_of_turn(config: &Self::Config, turned: N) -> N {
            turned.speed_of_turn(config.speed)
        }

        fn resync(&mut self, angle: u32) {
            self.angle = AngleTracker::new(angle);
        }

        #[inline(always)]
        fn angle(&self) -> u32 {
            self.angle.angle()
        }
    };
}

mod angle;
mod backlash;
mod force_limit;
mod geared;
mod load_gear;
mod mechanism;
mod rigid;
mod semi_implicit;
mod two_mass;

pub use angle::{AngleTracker, Prediction};
pub use backlash::{BacklashConfig, BacklashObserver, Contact, FreeFlight, Gap, GapCorrection};
pub use force_limit::{ForceLimit, ForceLimitConfig};
pub use geared::{GearFriction, GearedConfig, GearedObserver, Stiction};
pub use load_gear::{LoadGearConfig, LoadGearObserver};
pub use mechanism::{MechanismConfig, MechanismObserver, TABLE_POINTS, TablePoint, Tool, ToolObserver};
pub use rigid::{RigidConfig, RigidObserver};
pub use semi_implicit::{SemiImplicitConfig, SemiImplicitObserver};
pub use two_mass::{TwoMassConfig, TwoMassObserver};

use crate::number::Number;
use crate::sample::Estimate;

/// An estimator of the drivetrain's state, advanced once a tick: predict, then correct or coast.
///
/// ```
/// use driveline::design::{Disturbance, Encoder, Rate};
/// use driveline::machine::{Inertia, Rigid};
/// use driveline::observer::{Observer, RigidConfig, RigidObserver};
/// use driveline::settings::Bases;
/// /// A recording of angles (2^-32 turn) under one torque through any observer: the load torque at its end.
/// fn load_torque<O: Observer<f64>>(config: &O::Config, angles: impl Iterator<Item = u32>, torque: f64) -> f64 {
///     let mut observer = O::at_rest(config, 0, 0.0);
///     angles.for_each(|angle| observer.step(config, angle, torque));
///     observer.estimate(config).load_torque
/// }
/// const LOAD: Disturbance = Disturbance { torque_accuracy: 3.0, load_torque_step: 150.0, within: 10.0 };
/// const CONFIG: RigidConfig<f64> = RigidConfig::<f64>::new(
///     &Rigid::new(Inertia(0.8)).observer(Rate::hz(10_000), Encoder::lines(2048), LOAD), 0.5, Bases::SI);
/// let held = load_torque::<RigidObserver<f64>>(&CONFIG, (0..20_000).map(|_| 0), 40.0);
/// assert!((held - 40.0).abs() < 0.1);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no observer in `{N}`",
    note = "the order is `Drive<Number, Observer, Governor, Fluctuation, Balancer>`, with `()` for a part left out"
)]
#[doc(alias("Luenberger", "state estimator"))]
pub trait Observer<N: Number>: Sized {
    /// Its constants, shared and immutable.
    type Config;
    /// States of its [`Prediction`].
    type States;

    /// A machine in steady motion at `speed` and `angle`, its shaft carrying `torque` against the load.
    fn steady(config: &Self::Config, angle: u32, torque: N, speed: N) -> Self;

    /// A machine at standstill at `angle`, its shaft carrying `torque`, as under a closed brake.
    fn at_rest(config: &Self::Config, angle: u32, torque: N) -> Self {
        Self::steady(config, angle, torque, N::ZERO)
    }

    /// Restarts from [`steady`](Self::steady), keeping data beyond the states.
    #[inline(always)]
    fn restart(&mut self, config: &Self::Config, angle: u32, torque: N, speed: N) {
        *self = Self::steady(config, angle, torque, speed);
    }

    /// Bumpless transfer from the constants `from` to `to`, between two ticks: the estimate is the same under both.
    ///
    /// For an observer whose states are quantities of the estimate nothing changes.
    fn switch(&mut self, _from: &Self::Config, _to: &Self::Config) {}

    /// The speed at which the motor turns by `turned` (2^-32 turn) in a tick.
    fn speed_of_turn(config: &Self::Config, turned: N) -> N;

    /// Resynchronises to the angle, whatever was predicted.
    fn resync(&mut self, angle: u32);

    /// Predicts the tick that has just ended, in which `torque` was applied and at the end of which `angle` was
    /// measured.
    fn predict(&self, config: &Self::Config, angle: u32, torque: N) -> Prediction<N, Self::States>;

    /// Makes the prediction, corrected by its innovation, the state.
    fn correct(&mut self, config: &Self::Config, predicted: Prediction<N, Self::States>, angle: u32);

    /// Makes the prediction for `angle` the state without correction: the angle cannot be used.
    fn coast(&mut self, predicted: Prediction<N, Self::States>, angle: u32);

    /// The present estimate.
    fn estimate(&self, config: &Self::Config) -> Estimate<N>;

    /// Torque that a mechanism takes at the present angle and speed, by its inertia and its weight; zero without one.
    #[inline(always)]
    fn known_torque(&self, _config: &Self::Config) -> N {
        N::ZERO
    }

    /// The last accepted angle, 2^32 per turn.
    fn angle(&self) -> u32;

    /// [`Number::beyond_base`] of all states.
    fn beyond_base(&self) -> u32;

    /// One tick with a plausible angle.
    #[inline(always)]
    fn step(&mut self, config: &Self::Config, angle: u32, torque: N) {
        let predicted = self.predict(config, angle, torque);
        self.correct(config, predicted, angle);
    }
}
