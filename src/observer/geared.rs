//! Gear losses, deducted from the motor's torque before an observer.

use super::{Observer, Prediction};
use crate::number::{Fixed, Magnitude, Number};
use crate::sample::Estimate;

/// Constants of [`GearedObserver`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct GearedConfig<N: Stiction, C> {
    /// Constants of the observer behind the gear.
    pub observer: C,
    /// Friction in motion.
    pub friction: GearFriction<N>,
    /// Stiction gain c (N m s/rad).
    pub stiction_gain: N::StictionGain,
    /// Deadband: largest innovation left out while the gear sticks (2^-32 turn).
    pub deadband: N,
}

/// Friction of a gear whose driving side supplies the loss.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct GearFriction<N: Number> {
    /// Friction per torque, lambda.
    pub share: N::Coefficient,
    /// Part of the torque that the observer finds too much, 1 - 1/k.
    pub excess: N::Coefficient,
}

impl<N: Number<Coefficient: Magnitude>> GearFriction<N> {
    /// From the friction per torque, as [`GearLoss`](crate::learning::GearLoss) learns it: from 0 to below 1, in fixed
    /// point to 1/2.
    #[must_use]
    pub fn of(share: f32) -> Self {
        // 1/k = sqrt(1 - lambda^2)
        let excess = 1.0 - crate::math::sqrt(f64::from(1.0 - share * share)) as f32;
        GearFriction { share: Magnitude::of(share), excess: Magnitude::of(excess) }
    }
}

impl<N: Number> GearFriction<N> {
    /// A torque behind the gear, as the observer finds it: kT, by two terms of the series of 1/(1 - excess).
    fn found(&self, torque: N) -> N {
        torque + (torque + torque.times(self.excess)).times(self.excess)
    }
}

/// An observer behind a gear with losses.
///
/// The driving side supplies the loss [Huang 1987 tables 1-2 to 1-4]: motoring, the motor carries T/eta for a shaft
/// torque T; overhauling, only eta T. Both are a torque kT less or plus a friction lambda kT that opposes the motion:
///
/// ```text
/// k (1 + lambda) = 1/eta,  k (1 - lambda) = eta:  lambda = (1 - eta^2)/(1 + eta^2),  k = (1 + eta^2)/(2 eta)
/// ```
///
/// At a standstill the friction takes any value up to that, and holds the gear. The observer behind it estimates kT from
/// the remaining torque of the motor,
///
/// ```text
/// tau = tau_m - friction,   friction = tau_m - kT + c omega_m, limited to +-lambda |kT|
/// ```
///
/// in motion the limit, at standstill the balance of motor and shaft, with c omega_m (the stiction gain) to bring the
/// estimate to rest. T is the torque after the gear, in shaft, rope and load. Without this a loss of 6 % is taken for
/// shaft torque, and its reversal for a jerk of the load.
///
/// While the gear sticks, the motor's angle contains no information on the load: it only moves within its own shaft's
/// twist. The innovation is then left out, up to the deadband, which covers such a turn. Within the deadband the
/// residual decays: a twist that was added to it would be taken for motion in the tick that breaks the gear loose.
/// Beyond the deadband it is kept, so that a gear that loses less than lambda, and creeps, is followed.
///
/// ```
#[doc = include_str!("../roll.txt")]
/// use driveline::configure::Configure;
/// use driveline::observer::{GearedConfig, GearedObserver, Observer, TwoMassConfig};
/// use driveline::settings::Gear;
/// // the roll behind a gear that loses 3 %
/// const GEAR: Gear = Gear { efficiency: 0.97, inertia: 0.35, deadband: 0.0 };
/// const ROLL: TwoMassConfig<f64> = <TwoMassObserver as Configure<Roll, f64>>::CONFIG;
/// const CONFIG: GearedConfig<f64, TwoMassConfig<f64>> =
///     GearedConfig::<f64, _>::new(ROLL, &GEAR, 1e-4, driveline::settings::Bases::SI);
/// let mut observer = GearedObserver::<TwoMassObserver<f64>>::at_rest(&CONFIG, 0, 0.0);
/// // of 100 N m at 100 rad/s, 0.01 rad a tick, the shaft gets 97
/// for tick in 1..=20_000_u32 {
///     observer.step(&CONFIG, tick.wrapping_mul(6_835_653), 100.0);
/// }
/// assert!((observer.estimate(&CONFIG).shaft_torque - 97.0).abs() < 0.1);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct GearedObserver<O> {
    pub(crate) observer: O,
}

/// Stiction of a gear at rest, beside the operations of [`Number`].
pub trait Stiction: Number {
    /// Stiction gain: a factor for floats; in fixed point always
    /// [`STICTION_GAIN`](crate::number::STICTION_GAIN).
    type StictionGain: Copy + Default + PartialEq + core::fmt::Debug;
    /// The friction, of the torque that holds the gear and its limit, and the largest innovation to be left out: the
    /// `deadband` while the gear sticks, in motion one that every innovation exceeds.
    // By reference: in floats the load stays in its branch, three instructions less.
    fn friction(self, limit: Self, deadband: &Self) -> (Self, Self);
    /// The torque that brings a speed to rest; in fixed point it ends at twice the base.
    fn braked(self, stiction_gain: Self::StictionGain) -> Self;
}

impl Stiction for Fixed {
    type StictionGain = ();

    #[inline(always)]
    fn friction(self, limit: Self, deadband: &Self) -> (Self, Self) {
        // As `exceeds` counts, only half a turn is within the lowest number.
        (self.limited(limit), if self.exceeds(limit) { Fixed::from_bits(i32::MIN) } else { *deadband })
    }

    // 16 times: a saturation and a shift that the addition takes along.
    #[inline(always)]
    fn braked(self, _stiction_gain: ()) -> Self {
        Fixed::from_bits(self.to_bits().clamp(-(1 << 25), (1 << 25) - 1) << 4)
    }
}

macro_rules! stiction {
    ($float:ident) => {
        impl Stiction for $float {
            type StictionGain = $float;

            #[inline(always)]
            fn friction(self, limit: Self, deadband: &Self) -> (Self, Self) {
                if self > limit {
                    (limit, -1.0)
                } else if self < -limit {
                    (-limit, -1.0)
                } else {
                    (self, *deadband)
                }
            }

            #[inline(always)]
            fn braked(self, stiction_gain: Self) -> Self {
                stiction_gain * self
            }
        }
    };
}

stiction!(f32);
stiction!(f64);

impl<N: Stiction, O: Observer<N>> Observer<N> for GearedObserver<O> {
    type Config = GearedConfig<N, O::Config>;
    /// The observer's, and the largest innovation to be left out.
    type States = (O::States, N);

    fn restart(&mut self, config: &Self::Config, angle: u32, torque: N, speed: N) {
        self.observer.restart(&config.observer, angle, config.friction.found(torque), speed);
    }

    fn steady(config: &Self::Config, angle: u32, torque: N, speed: N) -> Self {
        let torque = config.friction.found(torque);
        GearedObserver { observer: O::steady(&config.observer, angle, torque, speed) }
    }

    #[inline(always)]
    fn predict(&self, config: &Self::Config, angle: u32, torque: N) -> Prediction<N, Self::States> {
        let now = self.observer.estimate(&config.observer);
        let limit = now.shaft_torque.times(config.friction.share).magnitude();
        let holding = torque - now.shaft_torque + now.motor_speed.braked(config.stiction_gain);
        let (friction, deadband) = holding.friction(limit, &config.deadband);
        self.observer.predict(&config.observer, angle, torque - friction).with(deadband)
    }

    #[inline(always)]
    fn correct(&mut self, config: &Self::Config, predicted: Prediction<N, Self::States>, angle: u32) {
        let (predicted, deadband) = predicted.split();
        if !predicted.innovation().exceeds(deadband) {
            core::hint::cold_path();
            // a motor that has left the deadband since the last correction moves: nothing of that may be forgotten
            let moved = N::from_angle(angle.wrapping_sub(self.observer.angle()) as i32);
            let kept = if moved.exceeds(deadband) { predicted } else { predicted.decayed() };
            self.observer.coast(kept, angle);
        } else {
            self.observer.correct(&config.observer, predicted, angle);
        }
    }

    #[inline(always)]
    fn coast(&mut self, predicted: Prediction<N, Self::States>, angle: u32) {
        self.observer.coast(predicted.split().0, angle);
    }

    #[inline(always)]
    fn estimate(&self, config: &Self::Config) -> Estimate<N> {
        let now = self.observer.estimate(&config.observer);
        let behind = |torque: N| torque - torque.times(config.friction.excess);
        Estimate { shaft_torque: behind(now.shaft_torque), load_torque: behind(now.load_torque), ..now }
    }

    passed_on!();
}

#[cfg(test)]
mod tests {
    use super::Stiction;

    /// At its limit of 2 a gear still sticks, beyond it slips: then even no innovation is too large to be left out.
    #[test]
    fn a_gear_sticks_up_to_its_limit_and_slips_beyond() {
        for (holding, friction, sticks) in
            [(0.5, 0.5, true), (2.0, 2.0, true), (-2.0, -2.0, true), (2.1, 2.0, false), (-2.1, -2.0, false)]
        {
            let (found, left_out) = f32::friction(holding, 2.0, &8.0);
            assert_eq!((found, left_out == 8.0, left_out < 0.0), (friction, sticks, !sticks), "{holding}");
        }
    }
}
