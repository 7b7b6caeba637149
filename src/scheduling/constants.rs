//! Interpolation of the constants of observers and governors, field by field.

use crate::governor::{LagConfig, SpeedLoopConfig};
use crate::number::{Interpolate, Magnitude, Number, Weight};
use crate::observer::{GearFriction, GearedConfig, RigidConfig, SemiImplicitConfig, Stiction, TwoMassConfig};

/// Each field of a configuration between those of two others.
macro_rules! fields {
    ($([$($generic:tt)*] $config:ident<$($argument:ident),+> { $($field:ident),+ })+) => {$(
        impl<$($generic)*> Interpolate for $config<$($argument),+>
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
    [N] RigidConfig<N> { acceleration, turn, correction, angle_correction, speed, load_share }
    [N] SemiImplicitConfig<N> { motor, load, shaft, turn, correction, angle_correction, speed }
    [N] LagConfig<N> { share }
    [N, F: Interpolate] SpeedLoopConfig<N, F> { proportional, damping, reset, torque_limit, ramp, filter }
    [N] GearFriction<N> { share, excess }
    [N: Stiction<StictionGain: Interpolate>, C: Interpolate] GearedConfig<N, C> {
        observer, friction, stiction_gain, deadband
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
