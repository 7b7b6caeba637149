//! Interpolation of the constants of observers and governors, field by field.

use crate::governor::{LagConfig, SpeedLoopConfig};
use crate::number::{Interpolate, Magnitude, Number, Weight};
use crate::observer::{GearFriction, GearedConfig, RigidConfig, SemiImplicitConfig, Stiction, TwoMassConfig};

macro_rules! fields {
    ($($config:ident { $($field:ident),+ })+) => {$(
        impl<N> Interpolate for $config<N>
        where
            N: Number<Coefficient: Interpolate> + Interpolate,
        {
            fn between(&self, other: &Self, weight: Weight) -> Self {
                $config { $($field: self.$field.between(&other.$field, weight)),+ }
            }
        }
    )+};
}

fields! {
    RigidConfig { acceleration, turn, correction, angle_correction, speed, load_share }
    SemiImplicitConfig { motor, load, shaft, turn, correction, angle_correction, speed }
    LagConfig { share }
}

impl<N, F> Interpolate for SpeedLoopConfig<N, F>
where
    N: Number<Coefficient: Interpolate> + Interpolate,
    F: Interpolate,
{
    fn between(&self, other: &Self, weight: Weight) -> Self {
        SpeedLoopConfig {
            proportional: self.proportional.between(&other.proportional, weight),
            damping: self.damping.between(&other.damping, weight),
            reset: self.reset.between(&other.reset, weight),
            torque_limit: self.torque_limit.between(&other.torque_limit, weight),
            ramp: self.ramp.between(&other.ramp, weight),
            filter: self.filter.between(&other.filter, weight),
        }
    }
}

impl<N, C> Interpolate for GearedConfig<N, C>
where
    N: Stiction<Coefficient: Interpolate, StictionGain: Interpolate> + Interpolate,
    C: Interpolate,
{
    fn between(&self, other: &Self, weight: Weight) -> Self {
        GearedConfig {
            observer: self.observer.between(&other.observer, weight),
            friction: GearFriction {
                share: self.friction.share.between(&other.friction.share, weight),
                excess: self.friction.excess.between(&other.friction.excess, weight),
            },
            stiction_gain: self.stiction_gain.between(&other.stiction_gain, weight),
            deadband: self.deadband.between(&other.deadband, weight),
        }
    }
}

/// The compliance is the inverse of the interpolated stiffness.
impl<N> Interpolate for TwoMassConfig<N>
where
    N: Number<Coefficient: Magnitude>,
{
    fn between(&self, other: &Self, weight: Weight) -> Self {
        let inverse = weight.of_inverses(&self.shaft[0], &other.shaft[0]);
        TwoMassConfig {
            forcing: self.forcing.between(&other.forcing, weight),
            twist: self.twist.between(&other.twist, weight),
            twist_rate: self.twist_rate.between(&other.twist_rate, weight),
            acceleration: self.acceleration.between(&other.acceleration, weight),
            turn: self.turn.between(&other.turn, weight),
            correction: self.correction.between(&other.correction, weight),
            angle_correction: self.angle_correction.between(&other.angle_correction, weight),
            speed: self.speed.between(&other.speed, weight),
            share: self.share.between(&other.share, weight),
            shaft: self.shaft.between(&other.shaft, weight),
            compliance: self.compliance.between(&other.compliance, inverse),
        }
    }
}
