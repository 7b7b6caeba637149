//! What learners change in an observer and its constants.

use crate::learning::{EccentricityConfig, EccentricityNumber, EccentricityObserver};
use crate::number::{Magnitude, Number};
use crate::observer::{
    GearFriction, GearedConfig, GearedObserver, LoadGearConfig, LoadGearObserver, SemiImplicitConfig,
    SemiImplicitObserver, Stiction, TwoMassConfig, TwoMassObserver,
};

/// Constants of an observer that learners change.
pub trait Adjust {
    /// The friction per torque of a gear before the shaft; without one nothing changes.
    fn set_friction(&mut self, _friction: f32) {}

    /// The motor's inertia over the present one, within a quarter of it. The gains stay.
    fn scale_motor_inertia(&mut self, ratio: f32);
}

impl<N: Number<Coefficient: Magnitude>> Adjust for SemiImplicitConfig<N> {
    fn scale_motor_inertia(&mut self, ratio: f32) {
        self.motor = self.motor.scaled(1.0 / ratio);
    }
}

/// Of the twist's increments those by the natural frequency change with its square, to the first order of the step.
impl<N: Number<Coefficient: Magnitude>> Adjust for TwoMassConfig<N> {
    fn scale_motor_inertia(&mut self, ratio: f32) {
        // the load's inertia over the motor's
        let load = self.forcing[0].magnitude() / self.forcing[1].magnitude();
        let total = (1.0 + load) / (ratio + load);
        let square = (1.0 + load / ratio) / (1.0 + load);
        self.forcing[0] = self.forcing[0].scaled(1.0 / ratio);
        self.acceleration = self.acceleration.scaled(total);
        self.turn[1] = self.turn[1].scaled(total);
        self.share = [self.share[0].scaled(total), self.share[1].scaled(ratio * total)];
        let [n11, n12, g1] = self.twist;
        self.twist = [n11.scaled(square), n12, g1];
        let [n21, n22, g2] = self.twist_rate;
        self.twist_rate = [n21.scaled(square), n22.scaled(square), g2];
    }
}

impl<N: Stiction<Coefficient: Magnitude>, C: Adjust> Adjust for GearedConfig<N, C> {
    fn set_friction(&mut self, friction: f32) {
        self.friction = GearFriction::of(friction);
    }

    fn scale_motor_inertia(&mut self, ratio: f32) {
        self.observer.scale_motor_inertia(ratio);
    }
}

impl<N: Stiction, C: Adjust> Adjust for LoadGearConfig<N, C> {
    fn set_friction(&mut self, friction: f32) {
        self.observer.set_friction(friction);
    }

    fn scale_motor_inertia(&mut self, ratio: f32) {
        self.observer.scale_motor_inertia(ratio);
    }
}

/// An observer with an eccentricity to be learnt, by an [`EccentricityObserver`] anywhere in it; without one it is
/// zero.
pub(crate) trait HasEccentricity {
    /// As [`EccentricityObserver::learn`].
    fn learn_eccentricity(&mut self, _config: &EccentricityConfig, _speed: f32) {}

    /// As [`EccentricityObserver::eccentricity`].
    fn learnt_eccentricity(&self) -> [i32; 2] {
        [0; 2]
    }

    /// As [`EccentricityObserver::restore`].
    fn restore_eccentricity(&mut self, _config: &EccentricityConfig, _eccentricity: [i32; 2]) {}
}

impl<N> HasEccentricity for SemiImplicitObserver<N> {}
impl<N> HasEccentricity for TwoMassObserver<N> {}

impl<O, N: EccentricityNumber> HasEccentricity for EccentricityObserver<O, N> {
    fn learn_eccentricity(&mut self, config: &EccentricityConfig, speed: f32) {
        self.learn(config, speed);
    }

    fn learnt_eccentricity(&self) -> [i32; 2] {
        self.eccentricity()
    }

    fn restore_eccentricity(&mut self, config: &EccentricityConfig, eccentricity: [i32; 2]) {
        self.restore(config, eccentricity);
    }
}

macro_rules! behind {
    ($($observer:ident),+) => {$(
        impl<O: HasEccentricity> HasEccentricity for $observer<O> {
            fn learn_eccentricity(&mut self, config: &EccentricityConfig, speed: f32) {
                self.observer.learn_eccentricity(config, speed);
            }

            fn learnt_eccentricity(&self) -> [i32; 2] {
                self.observer.learnt_eccentricity()
            }

            fn restore_eccentricity(&mut self, config: &EccentricityConfig, eccentricity: [i32; 2]) {
                self.observer.restore_eccentricity(config, eccentricity);
            }
        }
    )+};
}

behind!(GearedObserver, LoadGearObserver);
