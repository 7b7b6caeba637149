//! The observer of a cranked machine: one mass whose inertia depends on the angle.
//!
//! A press, a shear, a pump: the slider follows the crank, and the inertia at the motor swings with it,
//!
//! ```text
//! J(phi) omega' = tau_m - tau_L - 1/2 J'(phi) omega^2
//! ```
//!
//! [derived; J(phi): Wang 1989 (1-15)]. An observer of constant inertia takes the exchange of kinetic energy for load
//! torque. Here it is reckoned with: the rigid observer of the mean inertia J is given the torque
//!
//! ```text
//! tau = tau_L + J/J(phi) (tau_m - tau_L - 1/2 J'(phi) omega^2)
//! ```
//!
//! under which a machine of constant inertia would move as this one does. `J/J(phi)` and `1/2 J'(phi)` come from a
//! table of constants over a turn of the crank, straight between its points.
//!
//! The crank's angle follows from the motor's, exactly whatever the gear, once it is known: [`CrankObserver::home`].

use super::{Observer, Prediction, RigidConfig, RigidObserver};
use crate::angle::{RotorAngle, RotorAngleConfig};
use crate::number::{Number, Part};
use crate::sample::Estimate;

/// Places of the table on a turn of the crank. A second harmonic of the inertia is off by 0.5 % of its amplitude at
/// most.
pub const TABLE_POINTS: usize = 64;

/// Binary places of an angle below the table's.
const BELOW: u32 = 32 - TABLE_POINTS.trailing_zeros();

/// The machine with its crank at one angle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TablePoint<N> {
    /// Mean inertia over the inertia here.
    pub inertia_ratio: N,
    /// Torque that the turning crank takes at the base of the speed, or at 1 rad/s: half the derivative of the inertia
    /// (N m s2/rad2).
    pub inertia_slope: N,
}

/// Constants of [`CrankObserver`]. Made by [`crate::settings`] from a design; the fields are in SI units for floats.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CrankConfig<N: Number> {
    /// Constants of the rigid observer of the mean inertia.
    pub rigid: RigidConfig<N>,
    /// Turns of the crank to those of the motor.
    pub turning: RotorAngleConfig,
    /// The machine from the crank's top dead centre on.
    pub points: [TablePoint<N>; TABLE_POINTS],
}

/// State of the observer of a cranked machine.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CrankObserver<N = f32> {
    rigid: RigidObserver<N>,
    /// Motor torque less the torque that the rigid observer was given.
    inertia_torque: N,
    turning: RotorAngle,
}

impl<N> Part<N> for CrankObserver {
    type State = CrankObserver<N>;
}

impl<N: Number> CrankObserver<N> {
    /// Homing: sets the crank's angle from the top dead centre (2^-32 turn), positive as the motor's.
    ///
    /// Until then it counts from where the observer was started. It stays valid as long as the motor's angle is
    /// measured at least every half turn. After [`crate::fault::Faults::ANGLE_LOST`] the shorter displacement is
    /// assumed: home a crank behind a gear again.
    pub fn home(&mut self, config: &CrankConfig<N>, crank_angle: u32) {
        self.turning.set(&config.turning, crank_angle);
    }

    /// The crank's angle from the top dead centre (2^-32 turn), with the resolution of 2^-26 turns.
    pub fn crank_angle(&self, config: &CrankConfig<N>) -> u32 {
        self.turning.angle(&config.turning)
    }

    #[inline(always)]
    fn follow(&mut self, config: &RotorAngleConfig, angle: u32) {
        if !self.turning.follow(config, angle) {
            self.turning.wrap(config);
        }
    }
}

/// Inertia ratio and slope at an angle of the crank.
#[inline(always)]
fn at<N: Number>(points: &[TablePoint<N>; TABLE_POINTS], angle: u32) -> TablePoint<N> {
    let index = (angle >> BELOW) as usize;
    let from = points.get(index).copied().unwrap_or_default();
    let to = points.get((index + 1) & (TABLE_POINTS - 1)).copied().unwrap_or_default();
    let part = N::fraction(angle << (32 - BELOW));
    TablePoint {
        inertia_ratio: from.inertia_ratio + (to.inertia_ratio - from.inertia_ratio).scaled(part),
        inertia_slope: from.inertia_slope + (to.inertia_slope - from.inertia_slope).scaled(part),
    }
}

impl<N: Number> Observer<N> for CrankObserver<N> {
    type Config = CrankConfig<N>;
    type States = (<RigidObserver<N> as Observer<N>>::States, N);

    /// The crank is at its top dead centre.
    fn steady(config: &CrankConfig<N>, angle: u32, torque: N, speed: N) -> Self {
        let mut cranked = CrankObserver {
            rigid: RigidObserver::steady(&config.rigid, angle, torque, speed),
            ..CrankObserver::default()
        };
        cranked.follow(&config.turning, angle);
        cranked.home(config, 0);
        cranked
    }

    /// The crank has turned with the motor since the last accepted angle.
    fn restart(&mut self, config: &CrankConfig<N>, angle: u32, torque: N, speed: N) {
        self.rigid.restart(&config.rigid, angle, torque, speed);
        self.inertia_torque = N::ZERO;
        self.follow(&config.turning, angle);
    }

    fn speed_of_turn(config: &CrankConfig<N>, turned: N) -> N {
        RigidObserver::speed_of_turn(&config.rigid, turned)
    }

    fn resync(&mut self, angle: u32) {
        self.rigid.resync(angle);
    }

    #[inline(always)]
    fn predict(&self, config: &CrankConfig<N>, angle: u32, torque: N) -> Prediction<N, Self::States> {
        let TablePoint { inertia_ratio, inertia_slope } = at(&config.points, self.turning.angle(&config.turning));
        let Estimate { motor_speed, load_torque, .. } = self.rigid.estimate(&config.rigid);
        let taken = inertia_slope.scaled(motor_speed.scaled(motor_speed));
        let accelerating = (torque - load_torque - taken).saturated();
        let given = inertia_ratio.scaled(accelerating) + load_torque;
        self.rigid.predict(&config.rigid, angle, given).with(torque - given)
    }

    #[inline(always)]
    fn correct(&mut self, config: &CrankConfig<N>, predicted: Prediction<N, Self::States>, angle: u32) {
        let (predicted, inertia_torque) = predicted.split();
        self.rigid.correct(&config.rigid, predicted, angle);
        self.inertia_torque = inertia_torque;
        self.follow(&config.turning, angle);
    }

    /// The crank's angle stays at the last accepted one.
    #[inline(always)]
    fn coast(&mut self, predicted: Prediction<N, Self::States>, angle: u32) {
        let (predicted, inertia_torque) = predicted.split();
        self.rigid.coast(predicted, angle);
        self.inertia_torque = inertia_torque;
    }

    /// The shaft is that between the motor and the crank drive: its torque is the motor's less that of the motor's own
    /// acceleration.
    #[inline(always)]
    fn estimate(&self, config: &CrankConfig<N>) -> Estimate<N> {
        let rigid = self.rigid.estimate(&config.rigid);
        Estimate { shaft_torque: rigid.shaft_torque + self.inertia_torque, ..rigid }
    }

    #[inline(always)]
    fn angle(&self) -> u32 {
        self.rigid.angle()
    }

    #[inline(always)]
    fn beyond_base(&self) -> u32 {
        Observer::<N>::beyond_base(&self.rigid)
    }
}
